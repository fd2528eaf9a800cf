#!/usr/bin/env python3
"""How fluent the dashboard stays with 50 nodes, 500 instances and 10 events a
second. What answers is fake_cell.py, a load that is made up; how the page behaves
with a real cell is tried by dashboard_test.py."""

import pathlib
import re
import sys
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser  # noqa: E402
from fake_cell import PAGE, serve  # noqa: E402

SECONDS = 5
PLAIN_SECONDS = 3
# Of 95 of 100 frames, and of the longest piece of work: what a person sees as fluent
# where the page has a core to itself.
MOST_FRAME_MS = 34
MOST_TASK_MS = 150
# How much of the time the page may work on a core, as a multiple of what a plain table
# works there just before and just after: a core may be slow, or shared. On a virtual core
# of an AMD EPYC that nobody else had, it is a quarter of the time.
MOST_WORK = 1.85

# How far frames are apart, what the page works, and how much of the time.
MEASURE = """
const [seconds, done] = arguments;
const gaps = [];
const long = [];
new PerformanceObserver((list) => list.getEntries().forEach((x) => long.push(x.duration))).observe({type: 'longtask'});
let last = performance.now();
const end = last + seconds * 1000;
const step = (time) => {
  gaps.push(time - last);
  last = time;
  if (time < end) return requestAnimationFrame(step);
  gaps.sort((a, b) => a - b);
  const at = (share) => gaps[Math.min(gaps.length - 1, Math.floor(gaps.length * share))];
  done({frames: gaps.length, median: at(0.5), p95: at(0.95), most: gaps.at(-1), longest: Math.max(0, ...long), long: long.length});
};
requestAnimationFrame(step);
"""

# A table as large as the largest one of the dashboard, written anew five times a second.
PLAIN_TABLE = """
const table = document.body.appendChild(document.createElement('table'));
for (let i = 0; i < 100; ++i) {
  const row = table.insertRow();
  for (let j = 0; j < 8; ++j) row.insertCell();
}
let round = 0;
setInterval(() => {
  ++round;
  for (const cell of table.querySelectorAll('td')) cell.textContent = 'value ' + round;
}, 200);
"""


class LoadTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.url = serve(rate_hz=10)
        cls.page = Browser(cls.url)
        cls.page.driver.set_script_timeout(60)

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def work_of(self, seconds):
        """What the page measures of itself, and its work meanwhile."""
        before = self.page.work()
        measured = self.page.driver.execute_async_script(MEASURE, seconds)
        return measured, self.page.work() - before

    def work_of_plain_table(self):
        """How much of the time a plain table works on a core."""
        self.page.driver.get("about:blank")
        self.page.js(PLAIN_TABLE)
        return self.work_of(PLAIN_SECONDS)[1].core_s / PLAIN_SECONDS

    def test_50_nodes_and_500_instances_at_10_events_a_second_stay_fluent(self):
        print()
        plain = self.work_of_plain_table()
        for name in ("site", "instances", "tasks", "tasks/task-01", "events", "nodes/node-01"):
            self.page.open(f"#/{name}")
            self.page.until(lambda: self.page.text("main").count("\n") > 10)
            x, work = self.work_of(SECONDS)
            before, plain = plain, self.work_of_plain_table()
            times = work.core_s / SECONDS / max(before, plain)
            print(f"    {name:14} frames {x['median']:.1f} ms, 95 % under {x['p95']:.1f}, most {x['most']:.0f}; "
                  f"{x['long']} tasks over 50 ms, longest {x['longest']:.0f}; works {100 * work.core_s / SECONDS:.1f} % "
                  f"of the time, {times:.2f} times a plain table, "
                  f"{work.slowdown():.1f} times as long as with a core to itself")
            self.assertLess(x["p95"], MOST_FRAME_MS * work.slowdown(), name)
            self.assertLess(x["longest"], MOST_TASK_MS * work.slowdown(), name)
            self.assertLess(times, MOST_WORK, name)

    def test_few_questions_are_asked_however_many_events_come(self):
        self.page.open("#/events")
        self.page.js("performance.clearResourceTimings()")
        self.page.driver.execute_async_script(MEASURE, SECONDS)
        self.assertLessEqual(len(self.page.asked()), 2 * SECONDS, self.page.asked())

    def test_the_page_is_small_and_names_each_of_its_parts(self):
        start = (PAGE / "start.js").read_text()
        parts = [x.relative_to(PAGE).as_posix() for x in PAGE.rglob("*") if x.is_file()]
        named = [f"{folder}/{name}.js" for folder, names in re.findall(r"^  (\w+): ((?:'[^']*'\s*\+?\s*)+),$", start, re.M)
                 for name in re.sub(r"'\s*\+\s*'|'", "", names).split()]
        self.assertEqual(sorted(x for x in parts if "/" in x), sorted(named))
        self.assertLess(sum((PAGE / x).stat().st_size for x in parts), 200 * 1024)

    def test_a_page_that_was_left_holds_no_connection(self):
        # A browser has six connections for one server.
        for _ in range(12):
            self.page.open("#/site")
        self.page.sees("node-01")

    def test_a_node_that_goes_away_is_told_and_found_again(self):
        page = self.page
        page.open("#/site")
        request = urllib.request.Request(self.url.replace("/dashboard/", "/fake/away"), data=b"4")
        urllib.request.urlopen(request).read()
        page.sees("The node has not answered since", "Looking again", selector="#banner", patience=5)
        page.sees("away", selector="#link")
        page.sees("live", selector="#link", patience=20)
        page.until(lambda: page.js("return document.querySelector('#banner').hidden"))
        page.sees("node-01", "active")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
