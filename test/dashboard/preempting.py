"""Tests of who is preempted for whom, and of what is moved, in the dashboard's forms."""

import json


class MakingWay:
    """Needs what DashboardTest can do: `page`, `write_talk`, `document` and `stop`."""

    def write_wide(self, task, labels, **more):
        """One that fits twice on no node but the largest."""
        self.write_talk(task, labels=labels, **more)
        self.page.choose("/pipeline/0/model", "wide")

    def start_wide(self, task, labels, **more):
        self.write_wide(task, labels, **more)
        self.page.press("Start")
        self.page.sees(f"Task {task} runs")

    def test_what_is_less_important_is_shown_first_and_makes_way_when_it_is_told_to(self):
        page, told = self.page, "humble / talk on arm-1, priority 2"
        self.start_wide("humble", "place=left", priority="2")
        self.write_wide("urgent", "place=left", priority="8")
        page.press("Start")
        page.sees("Refused: no feasible allocation")
        self.assertNotIn(told, page.text())
        page.choose("/preempt", "show")
        self.assertEqual(self.document()["preempt"], "show")
        page.press("Start")
        page.sees("Refused: no feasible allocation", "What would be ended for it", told)
        page.go("#/tasks/humble")
        page.sees("humble", "running")
        page.go("#/plan")
        page.choose("/preempt", "yes")
        self.assertEqual(self.document()["preempt"], "yes")
        page.press("Start")
        page.sees("Task urgent runs", "What it has preempted", told)
        page.press("Look at it")
        page.sees("urgent", "arm-1", "running")
        page.go("#/tasks/humble")
        page.sees("it is preempted by task 'urgent'")
        self.stop("urgent")
        self.stop("humble")

    def test_a_rebalance_is_tried_out_before_anything_is_moved(self):
        page = self.page
        self.start_wide("filler", "place=rack")
        self.start_wide("roamer", "")
        # What has kept the other one from the largest node is gone.
        self.stop("filler")
        page.open("#/requests")
        page.press("Rebalance the cell", "nav.list")
        page.sees("Looks for a better placement of what runs")
        self.assertEqual(self.document(), {"type": "cell_rebalance", "dry_run": True})
        page.write("Least gain of the score", "0.001")
        page.write("Most moves", "3")
        self.assertEqual(self.document(), {"type": "cell_rebalance", "dry_run": True, "min_gain": 0.001, "most_moves": 3})
        page.press("Send", "main")
        page.sees("Done: cell rebalanced", "roamer / talk from edge-3 to head: planned", selector=".reply")
        reply = json.loads(page.js("return document.querySelector('.reply textarea').value"))
        self.assertFalse(reply["running"])
        self.assertLess(reply["after"], reply["before"])
        page.go("#/tasks/roamer")
        page.sees("edge-3", "running")
        self.stop("roamer")
