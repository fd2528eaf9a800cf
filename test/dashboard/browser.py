"""A headless browser that looks at the dashboard, and what a person does with it."""

import dataclasses
import os
import shutil
import tempfile
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

ARGUMENTS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
             "--no-first-run", "--disable-background-networking",
             "--disable-component-update", "--disable-sync", "--hide-scrollbars")
PATIENCE_S = float(os.environ.get("ROSCELL_DEADLINE_S", "30"))


@dataclasses.dataclass
class Work:
    """What a page has worked, in seconds by the clock and on a core."""
    clock_s: float
    core_s: float

    def __sub__(self, earlier):
        return Work(self.clock_s - earlier.clock_s, self.core_s - earlier.core_s)

    def slowdown(self):
        """How much longer it took because others had the cores, too."""
        return max(1.0, self.clock_s / self.core_s) if self.core_s else 1.0


class Browser:
    """One window with data of its own."""

    def __init__(self, url, width=1440, height=900):
        self.url = url
        self.folder = tempfile.mkdtemp(prefix="roscell-browser.")
        options = Options()
        options.binary_location = "/usr/bin/chromium"
        for argument in ARGUMENTS + (f"--user-data-dir={self.folder}",):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.execute_cdp_cmd("Performance.enable", {})
        self.size(width, height)

    def close(self):
        self.driver.quit()
        shutil.rmtree(self.folder, ignore_errors=True)

    def size(self, width, height, scale=1):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": scale, "mobile": False})

    def prefers(self, scheme):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def open(self, address=""):
        """Opens a page of the dashboard anew, and waits until the page knows the cell."""
        self.driver.get("about:blank")
        self.driver.get(self.url + address)
        try:
            self.until(lambda: self.js("return document.documentElement.dataset.ready") == "yes")
        except Exception as error:
            asked = self.js("""return performance.getEntriesByType('resource').slice(-12)
                .map((x) => [x.name.slice(-24), Math.round(x.startTime), Math.round(x.duration), x.responseStatus])""")
            raise AssertionError(f"{address} does not open: {self.text('body')[:300]} {asked} {self.complaints()}") from error

    def quicken(self):
        """From the next `open` on the page can be hidden, and what it does after seconds
        or a minute it does ten times as soon, or `pace` times as soon."""
        self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": """
            const plan = window.setTimeout.bind(window);
            window.pace = 10;
            window.setTimeout = (work, ms, ...parts) => plan(work, ms > 1000 ? ms / window.pace : ms, ...parts);
            window.unseen = false;
            Object.defineProperty(document, 'hidden', {get: () => window.unseen});
            window.hide = (whether) => {
              window.unseen = whether;
              document.dispatchEvent(new Event('visibilitychange'));
            };"""})

    def go(self, address):
        self.js("location.hash = arguments[0]", address)
        time.sleep(0.1)

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, condition, patience=PATIENCE_S):
        return WebDriverWait(self.driver, patience, 0.05, ignored_exceptions=(Exception,)).until(
            lambda _: condition())

    def text(self, selector="main"):
        return self.js("return document.querySelector(arguments[0])?.innerText ?? ''", selector)

    def sees(self, *words, selector="main", patience=PATIENCE_S):
        """Waits until all of these words stand there."""
        try:
            self.until(lambda: all(x in self.text(selector) for x in words), patience)
        except Exception as error:
            raise AssertionError(f"{words} cannot be read in: {self.text(selector)[:2000]}") from error

    def find(self, selector):
        return self.until(lambda: self.driver.find_element(By.CSS_SELECTOR, selector))

    def button(self, words, within="body"):
        """A button or link by its words, or by the name that is read aloud."""
        return self.until(lambda: next(
            x for x in self.driver.find_elements(By.CSS_SELECTOR, f"{within} button, {within} a")
            if words in (x.text.strip(), x.get_attribute("aria-label")) and x.is_displayed()))

    def press(self, words, within="body"):
        element = self.button(words, within)
        self.js("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def field(self, where):
        """The control of a JSON pointer in the task form, or of a label's words."""
        return self.until(lambda: self.js("""
            const [where] = arguments;
            const field = document.querySelector(`.field[data-where="${where}"]`);
            if (field) return field.querySelector('input, select');
            const label = [...document.querySelectorAll('label')].find((x) => x.textContent.startsWith(where));
            return label && document.getElementById(label.htmlFor);""", where))

    def write(self, where, text):
        element = self.field(where)
        self.js("""for (let x = arguments[0]; x; x = x.parentElement) if (x.tagName === 'DETAILS') x.open = true;
                   arguments[0].scrollIntoView({block: 'center'})""", element)
        element.send_keys(Keys.CONTROL, "a")
        element.send_keys(Keys.DELETE)
        element.send_keys(text)

    def choose(self, where, value):
        self.until(lambda: self.js("""
            const [element, value] = arguments;
            element.value = value;
            return element.value === value
              && (element.dispatchEvent(new Event('change', {bubbles: true})), true);""", self.field(where), value))

    def keys(self, *keys):
        for key in keys:
            self.driver.switch_to.active_element.send_keys(key)

    def picture(self, path):
        self.driver.save_screenshot(str(path))

    def asked(self):
        """What the page has asked of the node, by path."""
        return self.js("""return performance.getEntriesByType('resource')
            .map((x) => x.name).filter((x) => x.includes('/v1/')).map((x) => x.split('/v1/')[1])""")

    def work(self):
        metrics = self.driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
        values = {x["name"]: x["value"] for x in metrics}
        return Work(values["TaskDuration"], values["ThreadTime"])

    def complaints(self):
        """What the browser has to say against the page: errors, broken policies. That a
        question was refused is no error of the page."""
        return [x["message"] for x in self.driver.get_log("browser")
                if x["level"] == "SEVERE" and "Failed to load resource" not in x["message"]]
