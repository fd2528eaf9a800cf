// Puts the page together: what is known (cell/), the pages that show it (pages/),
// and which of them is open (page/router.js).
import { EventStream } from './cell/event_stream.js';
import { Metrics } from './cell/metrics.js';
import { applyEvent } from './cell/follow_events.js';
import { Questions } from './cell/questions.js';
import { Store } from './cell/store.js';
import { Announcer } from './page/announcer.js';
import { setAttribute, setText } from './page/dom.js';
import { Frame } from './page/frame.js';
import { place } from './page/router.js';
import { count } from './page/words.js';
import { PAGES } from './pages/pages.js';

/** A page that nobody sees lets the node go after this, and catches up when it is looked at. */
const HIDDEN_MS = 60000;
/** No first reading takes longer; events that are newer may not be in it. */
const READ_MS = 3000;
/** How long ago something was is said anew this often, though nothing happens. */
const TICK_MS = 5000;

const store = new Store();
const announcer = new Announcer(document.getElementById('announcer'));
const stream = new EventStream({ onEvents, onLink, onNode, onOpen });
const questions = new Questions(store, () => stream.cut());
const metrics = new Metrics(store, () => stream.cut(), questions.want);
const app = { store, metrics, questions, announcer, go: (hash) => { location.hash = hash; } };
const frame = new Frame(app, stream);
let page = null;

function onNode(node) {
  store.me = node;
  store.touch('me');
}

let caughtUp = false;
let late = [];

async function onOpen(again) {
  caughtUp = false;
  if (again)
    announcer.say('The node is back');
  // A task of such a name may have begun while nobody listened.
  store.ended.clear();
  await questions.readAll();
  caughtUp = true;
  // Clocks of nodes differ, so "while it was read" is counted back from the newest event.
  const newest = late.at(-1)?.time_unix_ms ?? 0;
  const doubtful = late.splice(0).filter((x) => x.time_unix_ms > newest - READ_MS);
  // In this order: what has been terminated in the end is not asked for.
  doubtful.filter((x) => x.event === 'task_terminated').forEach((x) => store.ended.add(x.subject));
  doubtful.forEach((x) => applyEvent(store, x, questions.ask));
  metrics.lookSoon();
  // The pages show it with the next frame.
  requestAnimationFrame(() => { document.documentElement.dataset.ready = 'yes'; });
}

function onEvents(events) {
  if (events.length === 0)
    return;
  store.addEvents(events.filter((x) => !x.passing));
  // What was before the page opened is in what is being read; what happens
  // meanwhile may not be, and is asked for after it.
  if (!caughtUp)
    return late.push(...events);
  events.forEach((x) => applyEvent(store, x, questions.ask));
  announcer.hear(events);
}

function onLink(state, retryAt) {
  if (state === 'away' && store.link.state === 'live')
    announcer.say('The node does not answer');
  store.setLink(state, retryAt);
}

function openPage() {
  const where = place();
  const Page = PAGES[where.page] ?? PAGES.site;
  page?.close?.();
  metrics.request();
  page = new Page(app, where);
  frame.show(where, page);
  page.update(new Set(['all']));
}

store.subscribe((kinds) => {
  frame.update(kinds);
  page?.update(kinds);
  const problem = [...store.nodes.values()].filter((x) => x.state === 'lost').length;
  document.title = `${problem ? `(${count(problem, 'node')} lost) ` : ''}${store.cell?.cell ?? 'ROSCell'} · ROSCell`;
});

/** A page that has paused goes on once the link is live. */
function letGo() {
  stream.halt();
  page?.pause?.();
  store.setLink('paused');
}

let hiding;
function onVisibility() {
  clearTimeout(hiding);
  if (document.hidden)
    hiding = setTimeout(letGo, HIDDEN_MS);
  else if (stream.halted)
    stream.resume();
}
document.addEventListener('visibilitychange', onVisibility);

// A browser keeps pages that somebody may come back to, and with them their
// connections, of which it has six for one node.
window.addEventListener('pagehide', letGo);
window.addEventListener('pageshow', (event) => event.persisted && onVisibility());

setInterval(() => document.hidden || store.touch('time'), TICK_MS);
window.addEventListener('hashchange', openPage);
window.addEventListener('online', () => stream.lookNow());
setText(document.getElementById('loading'), '');
setAttribute(document.body, 'data-open', 'yes');
openPage();
onVisibility();
stream.run();
