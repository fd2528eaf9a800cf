#!/usr/bin/env python3
"""What the dashboard makes of faults that no real cell has when it is told to: logs
that break off, answers that are late, nodes that say nothing. What answers is
fake_cell.py."""

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

    @classmethod
    def tearDownClass(cls):
        cls.page.close()

    def row(self):
        return next(x for x in self.fake.rows() if x["spec"]["instance"] == INSTANCE)

    def set_state(self, state):
        row = self.row()
        row["state"] = state
        self.fake.say("instance_changed", INSTANCE, {"task": "task-01", "step": "step_3", "node": row["node"], "state": state})

    def end_logs(self):
        for reader in list(self.fake.log_readers):
            reader.set()

    # Logs.

    def test_a_log_that_breaks_off_is_followed_again_while_the_instance_lives(self):
        page = self.page
        self.set_state("running")
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
        self.set_state("running")

    def test_a_log_goes_on_as_soon_as_the_node_is_back(self):
        page = self.page
        self.set_state("running")
        page.open(f"#/instances/{INSTANCE}")
        page.sees("line 2 of", selector=".log")
        page.js("pace = 1")
        self.fake.away.set()
        self.end_logs()
        for listener in list(self.fake.listeners):
            listener.put(None)
        page.sees("the node does not answer. Looking again in 8 s")
        self.fake.away.clear()
        page.press("Look now")
        page.sees("Following.", patience=4)

    # Tabs that nobody sees.

    def test_a_hidden_tab_lets_the_node_go_and_catches_up(self):
        page = self.page
        self.set_state("running")
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


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
