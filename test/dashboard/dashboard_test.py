#!/usr/bin/env python3
"""What people do with the dashboard, in a headless browser and with a real cell.

Usage: dashboard_test.py --url URL --scene FILE [--pictures DIR] [TEST...]
The scene is what test/dashboard/scene.sh has written. With --pictures the page is
photographed for docs/pictures. Needs Debian's chromium, chromium-driver and
python3-selenium.
"""

import argparse
import json
import os
import pathlib
import signal
import sys
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from asking import Asking  # noqa: E402
from browser import Browser  # noqa: E402
import reading  # noqa: E402
from keeping_place import KeepingPlace  # noqa: E402
from preempting import MakingWay  # noqa: E402

OPTIONS = argparse.Namespace(url="", scene={}, pictures=None)


class DashboardTest(Asking, KeepingPlace, MakingWay, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = Browser(OPTIONS.url)

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def setUp(self):
        self.page.size(1440, 900)
        self.page.prefers("light")

    def write_talk(self, task, **more):
        """Fills in the form of a new task with one step of the skill `talk`."""
        page = self.page
        page.open("#/plan")
        page.write("/task", task)
        page.choose("/pipeline", "talk")
        page.press("Add a step")
        page.write("/pipeline/0/input/endpoint", f"{OPTIONS.scene['data']}/talk.in")
        page.write("/pipeline/0/output/endpoint", f"{OPTIONS.scene['data']}/{task}.out")
        for where, text in more.items():
            page.write(f"/pipeline/0/{where}", text)

    def stop(self, task):
        self.page.open(f"#/requests/task_termination?task={task}")
        self.page.press("Send", "main")
        self.page.sees("Done: task terminated")

    def document(self):
        return json.loads(self.page.js("return document.querySelector('main textarea').value"))

    # A task, from the form to its end.

    def test_a_task_is_started_from_the_form_and_its_log_is_followed(self):
        page = self.page
        self.write_talk("spoken", labels="place=rack")
        page.write("/pipeline/0/parameters/greeting", "good morning")
        page.choose("/pipeline/0/parameters/loud", "true")
        self.assertEqual(self.document()["pipeline"][0]["parameters"], {"greeting": "good morning", "loud": True})
        page.press("Start")
        page.sees("Task spoken runs")
        page.press("Look at it")
        page.sees("talk", "running", "Steps over nodes", selector="main")
        page.press("talk", "tbody")
        page.sees("good morning", selector=".log")
        with open(f"{OPTIONS.scene['data']}/talk.in", "a", encoding="utf-8") as source:
            source.write("a line that came later\n")
        page.sees("A LINE THAT CAME LATER", selector=".log")
        self.stop("spoken")
        page.go("#/tasks")
        page.until(lambda: "spoken" not in page.text())

    def test_what_is_wrong_with_a_request_is_marked_at_its_place(self):
        page = self.page
        self.write_talk("misspelt")
        page.write("/pipeline/0/parameters/patience_s", "61")
        page.press("Start")
        page.sees("Refused: schema violation", "/pipeline/0/parameters/patience_s")
        wrong = page.field("/pipeline/0/parameters/patience_s")
        self.assertEqual(wrong.get_attribute("aria-invalid"), "true")
        line = page.js("""const area = document.querySelector('main textarea');
            return area.value.split('\\n').findIndex((x) => x.includes('patience_s')) + 1""")
        self.assertEqual(page.text(".numbers .wrong"), str(line))

    def test_why_a_task_finds_no_place_is_told_of_each_candidate(self):
        page = self.page
        self.write_talk("too_large")
        page.choose("/pipeline/0/model", "large")
        page.press("Start")
        page.sees("Refused: no feasible allocation", "Why each candidate was refused", "memory", "head", "arm-1")
        page.go("#/events?find=request refused")
        page.sees("request refused", "task_request")

    def test_a_plan_is_made_anew_without_a_node_and_with_one_more(self):
        page = self.page
        self.write_talk("thought")
        page.press("Plan")
        page.sees("Where each step goes", "Score", selector=".plan")
        chosen = page.js("return document.querySelector('.plan tbody td').textContent")
        card, out = page.find(f"[data-node='{chosen}']"), page.find(".zone.out")
        page.js("arguments[0].scrollIntoView({block: 'center'})", out)
        ActionChains(page.driver).click_and_hold(card.find_element("css selector", "b")).move_to_element(out).release().perform()
        page.sees(f"As if {chosen} were not there", selector="main")
        page.until(lambda: page.js("return document.querySelector('.plan tbody td').textContent") != chosen)
        page.press(f"Bring back {chosen}")
        page.press("Think of one more node")
        page.write("/with/name", "paper-1")
        page.press("Add it to the plan")
        page.sees("As if paper-1 were there")
        page.sees("paper-1", selector=".zone")

    # What happens by itself.

    def test_a_node_that_dies_is_seen_and_said(self):
        page, victim = self.page, OPTIONS.scene["victim"]
        page.open("#/site")
        page.sees(victim["name"], "active")
        os.kill(victim["pid"], signal.SIGKILL)
        begun = time.monotonic()
        page.sees("lost", selector="tbody")
        page.sees(f"Node {victim['name']}", selector=".problems")
        page.sees(f"Node {victim['name']} is lost", selector="#announcer")
        self.assertIn("(1 node lost)", page.driver.title)
        self.assertEqual(page.text("#ways .amount"), "1")
        print(f"\n    seen {time.monotonic() - begun:.2f} s after its end", end="")
        page.go("#/events")
        page.sees("node lost", victim["name"], selector=".events")

    def test_an_open_dashboard_costs_the_node_under_a_hundredth_of_a_core(self):
        pid = OPTIONS.scene["coordinator"]["pid"]
        self.page.driver.get("about:blank")
        time.sleep(2)
        without = reading.cpu_share(pid, 20)
        self.page.open("#/site")
        time.sleep(2)
        cost = reading.cpu_share(pid, 20) - without
        print(f"\n    the node works {100 * without:.2f} % of a core without it, {100 * cost:.2f} % more with it", end="")
        # Sanitizers make a node several times as slow.
        self.assertLess(cost, 0.06 if reading.is_sanitized(pid) else 0.01)

    def test_nothing_is_polled_that_an_event_tells(self):
        page = self.page
        page.open("#/events")
        time.sleep(2)  # What had happened just before is asked for once.
        page.js("performance.clearResourceTimings()")
        time.sleep(12)
        self.assertEqual(page.asked(), [])
        page.go("#/site")
        time.sleep(12)
        self.assertLessEqual(len(page.asked()), 8, page.asked())

    # How it can be read and used.

    def test_every_text_can_be_read_in_light_and_in_dark(self):
        for scheme in ("light", "dark"):
            self.page.prefers(scheme)
            for name in ("site", "tasks", "instances", "events", "plan", "requests"):
                self.page.open(f"#/{name}")
                time.sleep(0.3)
                self.assertEqual(self.page.js(reading.FAINT_TEXTS), [], f"{name}, {scheme}")

    def test_it_is_whole_on_a_phone_a_tablet_and_at_twice_the_size(self):
        for width, height in ((360, 740), (820, 1180), (720, 450)):
            self.page.size(width, height)
            for name in ("site", "tasks", "instances", "topics", "skills", "events", "plan", "requests"):
                self.page.open(f"#/{name}")
                time.sleep(0.2)
                self.assertEqual(self.page.js(reading.TOO_WIDE), [], f"{name} at {width}")

    def test_every_control_has_a_name(self):
        for name in ("site", "tasks", "instances", "topics", "skills", "events", "plan", "requests"):
            self.page.open(f"#/{name}")
            self.assertEqual(self.page.js(reading.NAMELESS), [], name)

    def test_the_keyboard_is_enough(self):
        page = self.page
        page.open("#/site")
        page.keys("?")
        page.sees("Keys", "Go to tasks", "every 5 s at most", selector="dialog[open]")
        page.keys(Keys.ESCAPE)
        page.until(lambda: not page.js("return document.querySelector('dialog').open"))
        page.js("document.activeElement.blur()")
        page.keys("g", "i")
        page.sees("Instances", selector="h1")
        page.keys("/")
        self.assertEqual(page.js("return document.activeElement.type"), "search")
        page.open("#/site")
        for _ in range(40):
            page.keys(Keys.TAB)
            if "row-link" in (page.js("return document.activeElement.className") or ""):
                break
        first = page.js("return document.activeElement.textContent")
        page.keys(Keys.ARROW_DOWN)
        self.assertNotEqual(page.js("return document.activeElement.textContent"), first)
        page.keys(Keys.ENTER)
        page.sees("Resources over the last minutes")

    def test_the_first_picture_comes_within_a_second(self):
        before = self.page.work()
        self.page.open("#/site")
        first = self.page.js("return performance.getEntriesByName('first-contentful-paint')[0].startTime")
        slowdown = (self.page.work() - before).slowdown()
        print(f"\n    first picture after {first:.0f} ms, on cores that made it {slowdown:.1f} times as long", end="")
        self.assertLess(first, 1000 * slowdown)

    # Who may do what.

    def test_nothing_comes_from_elsewhere_and_no_policy_is_broken(self):
        page = self.page
        page.complaints()
        for name in ("site", "tasks", "instances", "topics", "skills", "events", "plan", "requests"):
            page.open(f"#/{name}")
        origin = page.js("return location.origin")
        elsewhere = [x for x in page.js("return performance.getEntriesByType('resource').map((x) => x.name)")
                     if not x.startswith(origin)]
        self.assertEqual(elsewhere, [])
        self.assertEqual(page.complaints(), [])

    def test_a_page_of_another_origin_can_do_nothing(self):
        stranger = reading.stranger()
        try:
            self.page.driver.get(f"http://localhost:{stranger.server_port}/")
            secret = OPTIONS.url.split("/dashboard/")[0]
            base = secret.rsplit("/", 1)[0]
            self.assertEqual(self.page.driver.execute_async_script(reading.TRESPASS, base, secret, self.trespass()), "nothing")
            self.page.driver.switch_to.frame(self.page.find("iframe"))
            self.assertEqual(self.page.driver.find_elements("css selector", "#page"), [])
            self.page.driver.switch_to.default_content()
        finally:
            stranger.shutdown()
            stranger.server_close()
        self.page.open("#/tasks")
        time.sleep(3)
        self.assertNotIn("trespass", self.page.text())
        # From the page itself the same is done, and can be seen.
        self.page.js("fetch(new URL('../v1/requests', document.baseURI), {method: 'POST', body: arguments[0]})", self.trespass())
        self.page.sees("trespass", "running")
        self.stop("trespass")

    def trespass(self):
        end = lambda name: {"endpoint": f"{OPTIONS.scene['data']}/{name}", "protocol": "file", "data_type": "text/plain"}
        return json.dumps({"type": "task_request", "task": "trespass", "pipeline": [
            {"id": "talk", "operation": "talk", "model": "plain", "input": end("talk.in"), "output": end("trespass.out")}]})

    def test_zz_pictures_are_taken(self):
        if not OPTIONS.pictures:
            self.skipTest("no --pictures")
        reading.take_pictures(self.page, OPTIONS.pictures)
        for path in OPTIONS.pictures.glob("dashboard_*.png"):
            self.assertLess(path.stat().st_size, 300_000, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--url", required=True, help="of the page, with its last slash")
    parser.add_argument("--scene", required=True, type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="where to put pictures")
    options, rest = parser.parse_known_args()
    OPTIONS.url, OPTIONS.pictures = options.url, options.pictures
    OPTIONS.scene = json.loads(options.scene.read_text())
    unittest.main(argv=[sys.argv[0], "-v", *rest])


if __name__ == "__main__":
    main()
