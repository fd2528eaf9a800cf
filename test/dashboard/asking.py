"""Tests of what is asked of a cell and why: copies of tasks, decisions, requests that
are written half by a form and half by hand."""

import json


class Asking:
    """Needs what DashboardTest can do: `page`, `write_talk`, `document` and `stop`."""

    def write_json(self, text):
        self.page.js("""const area = document.querySelector('main textarea');
            area.value = arguments[0];
            area.dispatchEvent(new Event('input'));""", text)

    def test_a_copy_of_a_task_says_all_that_is_known_of_it_and_what_is_not(self):
        page = self.page
        self.write_talk("model", labels="place=rack", priority="3")
        page.choose("/pipeline/0/restart", "always")
        page.press("Start")
        page.press("Look at it")
        page.sees("talk", "running", selector="main")
        page.press("Use as a new task")
        step = self.document()["pipeline"][0]
        self.assertEqual((self.document()["task"], step["priority"], step["restart"]["policy"]), ("model-2", 3, "always"))
        self.assertEqual(len(step["build"]), 64)
        page.sees("Copied from what runs of task model. Which labels", "It writes where that task does", "/model.out")
        page.press("Plan")
        page.sees("Where each step goes")
        self.stop("model")

    def test_steps_of_a_copy_read_from_each_other_and_not_from_the_first_task(self):
        page = self.page
        page.open("#/tasks/fleet-poses")
        page.sees("camera_1")
        page.press("Use as a new task")
        steps = {x["id"]: x for x in self.document()["pipeline"]}
        self.assertEqual(steps["poses_1"]["input"], [{"from": "camera_1.image"}, {"from": "camera_1.camera_info"}])
        page.press("Plan")
        page.sees("Where each step goes")

    def test_why_a_task_is_where_it_is_or_was_refused_is_told_as_it_was_decided(self):
        page = self.page
        page.open("#/tasks/fleet-poses")
        page.press("Show how it was decided")
        page.sees("Decided ", "Score", "Where each step goes", "task request, ", "done after")
        page.js("document.querySelectorAll('main details').forEach((x) => { x.open = true; })")
        page.sees("Handler", "Of the node")
        self.write_talk("nowhere")
        page.choose("/pipeline/0/model", "large")
        page.press("Start")
        page.sees("Refused: no feasible allocation")
        page.go("#/tasks/nowhere")
        page.press("Show how it was decided")
        page.sees("Decided ", "Refused: no feasible allocation", "Why each candidate was refused", "refused: no feasible allocation after")

    def test_a_form_keeps_what_was_written_into_its_json_by_hand(self):
        page = self.page
        page.open("#/requests/node_drain?node=arm-1")
        self.write_json('{"type": "node_drain", "node": "arm-9", "request_id": "mine"}')
        self.assertEqual(page.field("Node").get_attribute("value"), "arm-9")
        page.js("arguments[0].click()", page.field("End at once"))
        self.assertEqual(self.document(), {"type": "node_drain", "node": "arm-9", "request_id": "mine", "force": True})
        self.write_json('{"type": "node_drain", "node": ')
        page.write("Node", "arm-2")
        page.sees("Not taken over: the JSON cannot be read.")
        self.assertEqual(page.js("return document.querySelector('main textarea').value"), '{"type": "node_drain", "node": ')

    def test_a_request_that_is_sent_again_is_done_once(self):
        page = self.page
        page.open("#/requests/cell_query")
        page.js("""window.sent = [];
            const ask = window.fetch;
            window.fetch = async (to, options) => {
              const answer = await ask(to, options);
              if (options?.method !== 'POST' || window.sent.push(options.body) > 1) return answer;
              throw new TypeError('the connection has broken');
            };""")
        page.go("#/requests/node_undrain?node=edge-3")
        page.press("Send", "main")
        page.sees("No answer", "It is not known whether it was done", "Look at edge-3")
        page.press("Send it again")
        page.sees("Done: node undrained")
        first, second = page.js("return window.sent.slice(0, 2)")
        self.assertEqual(first, second)
        self.assertTrue(json.loads(first)["request_id"].startswith("dashboard-"))
