"""How a page can be judged from outside: contrast, width, names, strangers, pictures."""

import http.server
import os
import pathlib
import threading
import time

# Texts whose contrast with what lies under them is below 4.5 (WCAG AA).
FAINT_TEXTS = """
const light = (x) => { x /= 255; return x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4; };
const luminance = ([r, g, b]) => 0.2126 * light(r) + 0.7152 * light(g) + 0.0722 * light(b);
const parts = (text) => (text.match(/[\\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
const ground = (element) => {
  for (let x = element; x; x = x.parentElement) {
    const colour = parts(getComputedStyle(x).backgroundColor);
    if (colour.length < 4 || colour[3] === 1) return colour;
  }
  return [255, 255, 255];
};
const faint = [];
for (const element of document.querySelectorAll('body *')) {
  const own = [...element.childNodes].some((x) => x.nodeType === 3 && x.data.trim());
  if (!own || element.closest('svg, :disabled, option, .sr, script, .stale') || !element.checkVisibility()) continue;
  const style = getComputedStyle(element);
  const [a, b] = [luminance(parts(style.color)), luminance(ground(element))].sort((x, y) => y - x);
  const contrast = (a + 0.05) / (b + 0.05);
  if (contrast < 4.5) faint.push(`${element.textContent.trim().slice(0, 40)}: ${contrast.toFixed(2)}`);
}
return [...new Set(faint)];
"""

# What sticks out of the page to the right. What scrolls in itself may be wider.
TOO_WIDE = """
const wide = [...document.querySelectorAll('body *')].filter((x) => {
  if (!x.checkVisibility() || x.closest('.scroll-x, svg, nav, .sr, .skip, .log, textarea, .list')) return false;
  return x.getBoundingClientRect().right > innerWidth + 1;
});
return wide.slice(0, 5).map((x) => `${x.tagName}.${x.className}: ${x.textContent.slice(0, 40)}`);
"""

NAMELESS = """
const named = (x) => x.getAttribute('aria-label') || x.textContent.trim() || x.title
  || (x.labels && [...x.labels].some((l) => l.textContent.trim()));
return [...document.querySelectorAll('button, a[href], input, select, textarea')]
  .filter((x) => x.checkVisibility() && (/^(INPUT|SELECT|TEXTAREA)$/.test(x.tagName)
    ? !(x.labels && [...x.labels].some((l) => l.textContent.trim())) : !named(x)))
  .map((x) => x.outerHTML.slice(0, 120));
"""

# What a page of another origin tries, even with the secret: to send, with and without
# a look at the answer, to read, and to look into a frame.
TRESPASS = """
const [base, secret, request, done] = arguments;
const tries = [
  ['read', () => fetch(secret + '/v1/cell').then((x) => x.text())],
  ['read a reply', () => fetch(secret + '/v1/requests', {method: 'POST', body: '{"type":"cell_query"}'}).then((x) => x.text())],
  ['send', () => fetch(base + '/v1/requests', {method: 'POST', body: request}).then((x) => x.text())],
  ['send as JSON', () => fetch(base + '/v1/requests',
    {method: 'POST', body: request, headers: {'Content-Type': 'application/json'}}).then((x) => x.text())],
  ...[base, secret].map((where) => ['send without a look at the answer', () => fetch(where + '/v1/requests',
    {method: 'POST', mode: 'no-cors', body: request}).then(() => Promise.reject())]),
];
const frame = document.createElement('iframe');
frame.src = secret + '/dashboard/';
const shown = new Promise((then) => { frame.onload = then; });
document.body.append(frame);
Promise.all(tries.map(([what, act]) => act().then(() => what, () => null))).then(async (got) => {
  await shown;
  let inside = null;
  try { inside = frame.contentWindow.document.body; } catch { /* As it should be. */ }
  const done_what = [...got, inside && 'look into the frame'].filter(Boolean);
  done(done_what.length ? done_what.join(', ') : 'nothing');
});
"""


def cpu_share(pid, seconds):
    """The part of a core that a process uses."""
    def used():
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    before, begun = used(), time.monotonic()
    time.sleep(seconds)
    return (used() - before) / (time.monotonic() - begun)


def is_sanitized(pid):
    return "libasan" in pathlib.Path(f"/proc/{pid}/maps").read_text()


def stranger():
    """A server of another origin, with an empty page."""
    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<!DOCTYPE html><title>elsewhere</title><body>")

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def plan_of(page, task):
    """Opens the plan of a task that runs, as if it were asked for once more."""
    page.open(f"#/tasks/{task}")
    page.press("Use as a new task")
    page.press("Plan")
    page.sees("Where each step goes")
    time.sleep(0.5)


def take_pictures(page, folder):
    folder.mkdir(parents=True, exist_ok=True)
    page.size(1440, 900)
    page.open("#/site")
    time.sleep(25)  # Until there are lines to see.
    page.picture(folder / "dashboard_site_light.png")
    page.go("#/tasks/fleet-poses")
    time.sleep(6)
    page.picture(folder / "dashboard_task_light.png")
    page.prefers("dark")
    time.sleep(0.3)
    page.picture(folder / "dashboard_task_dark.png")
    plan_of(page, "fleet-poses")
    page.js("document.querySelector('.plan').scrollIntoView()")
    page.js("scrollBy(0, -140)")
    page.picture(folder / "dashboard_plan_dark.png")
    page.prefers("light")
    page.size(820, 1180)
    page.open("#/tasks/fleet-poses")
    time.sleep(6)
    page.picture(folder / "dashboard_tablet.png")
    page.size(360, 740, 2)
    page.open("#/site")
    time.sleep(1)
    page.picture(folder / "dashboard_narrow.png")
