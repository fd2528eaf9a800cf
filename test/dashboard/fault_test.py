#!/usr/bin/env python3
"""What the dashboard makes of faults that no real cell has when it is told to: logs
that break off, answers that are late, nodes that say nothing. What answers is
fake_cell.py."""

import copy
import pathlib
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from fake_cell import Handler, serve  # noqa: E402

INSTANCE = "task-01-step_3-0000"


class FaultTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.url = serve(rate_hz=0, nodes=4, tasks=3)
        cls.fake = Handler.fake
        cls.page = Browser(cls.url)
        cls.page.quicken()
        cls.tasks = copy.deepcopy(cls.fake.tasks)

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def setUp(self):
        self.fake.tasks = copy.deepcopy(self.tasks)
        self.fake.skills = []
        self.fake.delays.clear()
        self.fake.lost.clear()
        self.fake.away.clear()

    def row(self):
        return next(x for x in self.fake.rows() if x["spec"]["instance"] == INSTANCE)

    def set_state(self, state):
        row = self.row()
        row["state"] = state
        self.fake.say("instance_changed", INSTANCE, {"task": "task-01", "step": "step_3", "node": row["node"], "state": state})

    def forget(self):
        self.fake.requests.clear()

    def asked(self, kind):
        return [x for x in self.fake.requests if x["type"] == kind]

    def end_logs(self):
        for reader in list(self.fake.log_readers):
            reader.set()

    # Logs.

    def test_a_log_that_breaks_off_is_followed_again_while_the_instance_lives(self):
        page = self.page
        page.open(f"#/instances/{INSTANCE}")
        page.sees("line 3 of", selector=".log")
        first = page.text(".log .line").split()[-1]
        self.end_logs()
        page.sees("The log has broken off. Looking again in 1 s.")
        page.until(lambda: first not in page.text(".log") and "line 2 of" in page.text(".log"), 10)
        self.assertEqual(page.text(".log").count("line 1 of"), 1)
        page.sees("Following.")
        self.set_state("stopped")
        page.sees("stopped", selector="h1")
        self.end_logs()
        page.sees("The log has ended.")
        time.sleep(2)
        self.assertEqual(len(self.fake.log_readers), 0)

    def test_a_log_goes_on_as_soon_as_the_node_is_back(self):
        page = self.page
        page.open(f"#/instances/{INSTANCE}")
        page.sees("line 2 of", selector=".log")
        page.js("pace = 1")
        self.fake.away.set()
        self.end_logs()
        for listener in list(self.fake.listeners):
            listener.put(None)
        page.sees("the node does not answer. Looking again in 8 s")
        self.fake.away.clear()
        # The page itself may be quicker, and then hides the button.
        page.js("document.querySelector('#banner button').click()")
        page.sees("Following.", patience=6)

    # Tabs that nobody sees.

    def test_a_hidden_tab_lets_the_node_go_and_catches_up(self):
        page = self.page
        page.open(f"#/instances/{INSTANCE}")
        page.sees("line 2 of", selector=".log")
        page.js("hide(true)")
        page.until(lambda: not self.fake.listeners and not self.fake.log_readers, 10)
        page.js("hide(false)")
        page.sees("live", selector="#link")
        page.until(lambda: len(self.fake.log_readers) == 1)

    def test_a_tab_that_is_opened_in_the_background_lets_the_node_go(self):
        page = self.page
        page.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": "unseen = sessionStorage.hidden === 'yes'"})
        page.open("#/site")
        page.js("sessionStorage.hidden = 'yes'")
        page.driver.refresh()
        page.until(lambda: self.fake.listeners)
        page.until(lambda: not self.fake.listeners, 10)
        page.js("sessionStorage.clear()")


    # Answers that are late.

    def test_an_old_answer_does_not_undo_what_an_event_has_told(self):
        page = self.page
        page.open("#/site")
        self.fake.delays["cell"] = 4
        time.sleep(2)  # The next look at the resources is on its way.
        self.set_state("failed")
        del self.fake.tasks["task-03"]
        self.fake.say("task_terminated", "task-03")
        page.go(f"#/instances?find={INSTANCE}")
        page.sees("failed", selector="tbody")
        self.row()["state"] = "stopped"
        time.sleep(4)
        # What the event said was asked for again after the old answer had come.
        page.sees("stopped", selector="tbody", patience=3)
        page.go("#/tasks")
        self.assertNotIn("task-03", page.text())

    def test_figures_of_what_is_gone_are_asked_for_no_more_and_its_page_leads_on(self):
        page, row = self.page, self.row()
        page.open(f"#/instances/{INSTANCE}")
        page.sees("running", selector="h1")
        row["spec"]["instance"] = "task-01-step_3-11111111"
        self.fake.say("instance_moved", INSTANCE, {"task": "task-01"})
        page.sees("no instance of that name")
        self.forget()
        time.sleep(3)
        self.assertEqual(self.asked("instance_query"), [])
        page.open("#/instances/task-01-step_3-22222222")
        page.press("What runs in its place")
        page.sees("task-01 / step_3", "running", selector="h1")
        self.assertIn("11111111", page.js("return location.hash"))

    def test_the_picture_of_a_task_leads_to_the_instances_that_run_now(self):
        page, row = self.page, self.row()
        page.open("#/tasks/task-01")
        links = lambda: page.js("return [...document.querySelectorAll('a.step')].map((x) => x.getAttribute('href'))")
        page.until(lambda: f"#/instances/{INSTANCE}" in links())
        page.until(lambda: "Hz" in page.js("return document.querySelector('.end .metrics').textContent"))
        row["spec"]["instance"] = "task-01-step_3-11111111"
        self.fake.say("instance_restarted", INSTANCE, {"task": "task-01"})
        page.until(lambda: "#/instances/task-01-step_3-11111111" in links())

    def test_what_happens_to_a_task_is_read_though_events_never_pause(self):
        page = self.page
        page.open("#/tasks/task-01")
        page.js("pace = 1")
        time.sleep(1.5)
        self.forget()
        for _ in range(12):
            self.fake.say("step_awaited", "step_3", {"task": "task-01"})
            self.fake.say("node_appeared", "node-99")
            time.sleep(0.25)
        self.assertGreaterEqual(len(self.asked("task_history_query")), 2)
        self.assertLessEqual(len(self.asked("task_history_query")), 4)

    def test_how_an_instance_ended_is_read_when_it_has_been_started_again(self):
        page, row = self.page, self.row()
        page.open(f"#/instances/{INSTANCE}")
        page.sees("running", selector="h1")
        self.assertNotIn("Earlier ends", page.text())
        row["ends"] = [{"unix_ms": 1700000000000, "exit_code": 3, "reason": "it fell over", "log": "oh"}]
        self.set_state("backing_off")
        page.sees("Earlier ends", "exit code 3 it fell over")

    # What stays where it is.

    def test_who_is_in_a_row_stays_there_when_others_go_or_rows_change_places(self):
        page = self.page
        page.open("#/instances?find=task-01")
        page.sees("step_3", "10 of")
        page.js("""window.moved = 0;
            new MutationObserver((list) => { moved += list.filter((x) => x.target.tagName === 'TBODY').flatMap((x) => [...x.addedNodes]).length; })
              .observe(document.querySelector('tbody'), {childList: true});""")
        focused = lambda: page.js("return document.activeElement.textContent")
        link = page.find(f"tbody a[href='#/instances/{INSTANCE}']")
        page.js("arguments[0].focus()", link)
        gone = self.fake.tasks["task-01"].pop(0)
        self.fake.say("step_stranded", "step_0", {"task": "task-01"})
        page.sees("9 of")
        self.assertEqual((focused(), page.js("return moved")), ("step_3", 0))
        self.fake.tasks["task-01"].insert(0, gone)
        page.press("State", "thead")
        page.js("arguments[0].focus()", link)
        self.set_state("backing_off")
        page.until(lambda: "step_3" in page.text("tbody tr"))
        self.set_state("running")
        page.until(lambda: "step_3" not in page.text("tbody tr"))
        self.assertEqual(focused(), "step_3")

    def test_a_form_is_left_alone_by_skills_that_come(self):
        page = self.page
        skill = lambda name: {"skill": {"descriptor": {
            "operation": name, "input": {"data_types": [], "protocols": ["file"]}, "output": {"data_types": [], "protocols": ["file"]},
            "models": [{"name": "plain", "parameters": {}, "deployments": [{"name": "cpu"}]}]}}, "nodes": ["node-01"]}
        self.fake.skills = [skill("carve")]
        page.open("#/plan")
        page.press("Add a step")
        page.js("arguments[0].setSelectionRange(2, 4)", page.field("/pipeline/0/id"))
        page.js("document.querySelector('details.life').open = true")
        self.fake.skills = [skill("carve"), skill("paint")]
        self.fake.say("skill_refused", "node-01")
        page.until(lambda: "paint" in page.text("main .adder select"))
        self.assertEqual(page.js("const x = document.activeElement; return [x.value, x.selectionStart, x.selectionEnd]"), ["carve", 2, 4])
        self.assertTrue(page.js("return document.querySelector('details.life').open"))

    def test_a_node_that_was_thought_away_and_is_lost_spoils_no_plan(self):
        page = self.page
        page.open("#/plan")
        page.press("Plan")
        page.press("Think away node-02")
        page.sees("As if node-02 were not there")
        self.assertEqual(self.asked("task_plan_query")[-1]["without"], ["node-02"])
        self.fake.lost.add("node-02")
        self.fake.say("node_lost", "node-02", {"reason": "no word"})
        page.sees("not there now: node-02", selector=".what-if")
        page.press("Plan")
        page.until(lambda: "without" not in self.asked("task_plan_query")[-1])

    # What time does.

    def test_how_long_a_task_has_run_goes_on_though_nothing_happens(self):
        page = self.page
        self.fake.started = int(time.time() * 1000)
        page.open("#/tasks")
        page.sees("task-01")
        since = page.text("tbody tr td:nth-of-type(2)")
        page.until(lambda: page.text("tbody tr td:nth-of-type(2)") != since, 12)

    def test_lines_of_resources_show_ten_minutes_at_most_and_only_nodes_that_are_there(self):
        self.page.open("#/site")
        spans = self.page.driver.execute_async_script("""
            const done = arguments[0], minute = 60000, none = {capacity: 1, used: 0};
            import(new URL('cell/samples.js', document.baseURI)).then(({Samples}) => {
              const samples = new Samples(), use = {cpu: none, memory_mib: none, disk_mib: none};
              const spans = [];
              for (let now = 0; now <= 30 * minute; now += minute) {
                samples.add('stays', use, now);
                if (now < 2 * minute) samples.add('lost', use, now);
                if (now < 29 * minute) samples.add('leaves', use, now);
                samples.prune(now < 29 * minute ? ['stays', 'lost', 'leaves'] : ['stays', 'lost'], now);
                spans.push(samples.span(now) / minute);
              }
              done([Math.max(...spans), samples.of('lost').length, samples.of('leaves').length, samples.of('stays').length,
                samples.span(60 * minute) / minute]);
            });""")
        self.assertEqual(spans, [10, 0, 0, 11, 10])

    def test_a_countdown_is_not_read_aloud_each_second(self):
        page = self.page
        page.open("#/site")
        self.fake.away.set()
        for listener in list(self.fake.listeners):
            listener.put(None)
        page.sees("The node has not answered since", "Looking again in", selector="#banner")
        loud = page.js("""return [...document.querySelectorAll('[role=alert], [role=status], [aria-live]')]
            .map((x) => x.textContent).filter((x) => x)""")
        self.fake.away.clear()
        self.assertTrue(any("The node has not answered" in x for x in loud), loud)
        self.assertFalse(any("Looking again" in x for x in loud), loud)
        page.sees("live", selector="#link")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
