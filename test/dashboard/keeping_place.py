"""Tests of what a person must not lose while the page brings itself up to date: the
keyboard's place, what they have opened, what they have written."""

import time

from selenium.webdriver.common.keys import Keys


class KeepingPlace:
    """Needs what DashboardTest can do: `page`, `write_talk` and `document`."""

    def focused(self):
        return self.page.js("const x = document.activeElement; return x.getAttribute('aria-label') ?? x.textContent")

    def test_the_way_to_the_content_leaves_a_half_written_form_alone(self):
        page = self.page
        page.open("#/requests/node_drain")
        page.write("Node", "half-writ")
        page.js("document.querySelector('.skip').focus()")
        page.keys(Keys.ENTER)
        time.sleep(0.5)
        self.assertEqual(page.js("return [location.hash, document.activeElement.id]"), ["#/requests/node_drain", "page"])
        self.assertEqual(page.field("Node").get_attribute("value"), "half-writ")

    def test_buttons_of_a_node_stay_under_the_keyboard_while_its_figures_come(self):
        page = self.page
        page.open("#/nodes/edge-3")
        drain = page.button("Drain", "main")
        page.js("arguments[0].focus()", drain)
        fact = page.find(".attributes dd")
        page.js("performance.clearResourceTimings()")
        for times in (1, 2):
            # Who has looked away asks at once; else a busy node is asked every 30 s.
            page.js("document.dispatchEvent(new Event('visibilitychange'))")
            page.until(lambda: len([x for x in page.asked() if x.startswith("cell?")]) >= times)
        time.sleep(0.5)
        self.assertEqual(self.focused(), "Drain")
        self.assertTrue(page.js("return arguments[0].isConnected && arguments[1].isConnected", drain, fact))

    def test_the_keyboard_stays_in_a_form_whose_rows_come_and_go(self):
        page = self.page
        self.write_talk("kept")
        page.js("document.querySelectorAll('main details').forEach((x) => { x.open = !x.open; })")
        shown = page.js("return [...document.querySelectorAll('main details')].map((x) => x.open)")
        add = page.button("Add an output")
        page.js("arguments[0].focus()", add)
        page.keys(Keys.ENTER)
        page.until(lambda: len(self.document()["pipeline"][0]["output"]) == 2)
        self.assertEqual(self.focused(), "Add an output")
        page.keys(Keys.SHIFT + Keys.TAB)
        self.assertEqual(self.focused(), "Remove this output")
        page.keys(Keys.NULL, Keys.ENTER)
        page.until(lambda: isinstance(self.document()["pipeline"][0]["output"], dict))
        self.assertEqual(self.focused(), "Add an output")
        self.assertEqual(page.js("return [...document.querySelectorAll('main details')].map((x) => x.open)"), shown)
        page.js("arguments[0].focus()", page.button("Remove step talk"))
        page.keys(Keys.ENTER)
        page.until(lambda: self.document()["pipeline"] == [])
        self.assertEqual(self.focused(), "Add a step")

    def test_a_finger_on_a_node_scrolls_the_page_and_drags_by_the_grip_only(self):
        page = self.page
        self.write_talk("touched")
        page.press("Plan")
        page.sees("Where each step goes", selector=".plan")
        touch = "return getComputedStyle(document.querySelector(arguments[0])).touchAction"
        self.assertEqual(page.js(touch, ".node-card"), "auto")
        self.assertEqual(page.js(touch, ".node-card .grip"), "none")
        page.js("document.querySelector('.zone.out').scrollIntoView({block: 'center'})")

        def swipe(selector):
            place = lambda x: page.js("""const x = document.querySelector(arguments[0]).getBoundingClientRect();
                return {x: x.left + 12, y: x.top + x.height / 2};""", x)
            begin, end = place(selector), place(".zone.out")
            between = {x: (begin[x] + end[x]) / 2 for x in "xy"}
            for kind, points in (("Start", [begin]), ("Move", [between]), ("Move", [end]), ("End", [])):
                page.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})

        swipe("[data-node='head'] .grip")
        page.sees("head", selector=".zone.out")
