// Why a request was refused: the sentence, what helps, each place that is wrong,
// and with a placement each candidate and its reasons.
import { Refusal } from '../cell/api.js';
import { button, el } from '../page/dom.js';
import { way } from '../page/router.js';
import { shape } from '../page/marks.js';
import { spoken } from '../page/words.js';
import { preemptedList, rejectedTable } from '../planning/plan_tables.js';

/** Who serves the page says with this that the node has not answered. */
const NO_ANSWER_STATUS = 502;

/** Of what was to change something. `again` sends the very same once more. */
export function openEnd(problem, sent, again) {
  const look = sent.task ? ['tasks', sent.task] : sent.node ? ['nodes', sent.node] : ['events'];
  return el('div', { class: 'refusal', role: 'alert' }, head('No answer', problem.message),
    el('p', {}, 'It is not known whether it was done. Sent again it is the same request, by its ', el('code', {}, 'request_id'),
      ': unless the node has been started anew meanwhile it is done once only, and its answer comes.'),
    el('p', { class: 'actions' }, button('Send it again', again),
      way(`Look at ${sent.task ?? sent.node ?? 'the events'}`, ...look)));
}

export function isOpenEnd(problem) {
  return !(problem instanceof Refusal) || problem.status === NO_ANSWER_STATUS || problem.code === 'timeout';
}

/** `box` is the JSON that was sent; `fields`, if given, marks the places in a form too. */
export function refusalView(problem, box, fields) {
  if (!(problem instanceof Refusal))
    return el('div', { class: 'refusal', role: 'alert' }, head('No answer', problem.message));
  const { error } = problem;
  const places = placesOf(error);
  const lines = box ? box.mark(places.map((x) => x.where)) : [];
  // That nothing fits is no mistake of a field.
  fields?.mark(error.rejected ? [] : places);
  return el('div', { class: 'refusal', role: 'alert' }, head(`Refused: ${spoken(error.code)}`, error.message),
    error.hint ? el('p', {}, el('b', {}, 'What helps: '), error.hint) : null,
    box && places.length > 0 ? el('ul', { class: 'places' }, places.map((x, index) => placeItem(x, lines[index], box))) : null,
    error.more ? el('p', {}, `and ${error.more} more`) : null,
    error.rejected?.length ? [el('h3', {}, 'Why each candidate was refused'), rejectedTable(error.rejected)] : null,
    error.preempted?.length ? [el('h3', {}, 'What would be ended for it'), preemptedList(error.preempted)] : null);
}

function head(words, message) {
  return el('p', { class: 'state bad refusal-head' }, shape('bad'), el('span', {}, el('b', {}, `${words}. `), message));
}

function placesOf(error) {
  if (error.errors?.length)
    return error.errors.map((x) => ({ where: x.where, words: x.expected }));
  return error.where ? [{ where: error.where, words: error.message }] : [];
}

function placeItem({ where, words }, line, box) {
  return el('li', {}, button(`line ${line}, ${where}`, () => box.goTo(where), { class: 'quiet' }), ' ', words);
}
