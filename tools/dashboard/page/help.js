// The page's own help: what it does by itself, and its keys.
import { button, el } from './dom.js';
import { shape } from './marks.js';

const MARKS = [
  ['good', 'runs, is there'], ['busy', 'is on its way: starting, stopping, switching'],
  ['warn', 'goes on, but not as it should: degraded, backing off, starved, draining'],
  ['bad', 'failed, lost, refused'], ['done', 'finished'], ['off', 'stopped, or in no cell'],
  ['unknown', 'not known: its node is away'],
];

const WORDS = [
  'The page reads the cell once, then follows the node’s events. What an event says is shown at once; what it does '
  + 'not say is asked for, in at most two rounds of questions a second.',
  'Metrics that no event tells (what is used of the nodes, rates, latencies) are asked for every 5 s at most, only '
  + 'those of the page that is open, only while the page can be seen, and more seldom where the answer takes long: a '
  + 'hundred times its duration lies between two questions. The lines of the last ten minutes begin when the page is opened.',
  'A page that has been hidden for a minute lets go of the node, and reads what it has missed when it is looked at again. '
  + 'If the node does not answer, the page says so and looks again, after 0.5 s at first and every 15 s at last.',
  'Every request is shown as the JSON that is sent, with a request_id. It can be changed, copied, and sent with `roscell request` as well.',
];

export function openHelp(keys) {
  const dialog = document.getElementById('dialog');
  if (dialog.open)
    return;
  dialog.replaceChildren(
    el('h2', { id: 'dialog-title' }, 'Help'),
    el('h3', {}, 'Keys'), keys.list(),
    el('p', { class: 'soft' }, 'In tables the arrow keys go from row to row, and Enter opens.'),
    el('h3', {}, 'Marks'),
    el('ul', { class: 'marks' }, MARKS.map(([kind, meaning]) => el('li', { class: `state ${kind}` }, shape(kind), ` ${meaning}`))),
    el('h3', {}, 'What is asked of the node, and when'),
    ...WORDS.map((text) => el('p', {}, text)),
    button('Close', () => dialog.close(), { class: 'main', autofocus: true }));
  dialog.showModal();
}
