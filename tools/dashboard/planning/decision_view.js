// Why a task is where it is, or was refused: what was decided when it was asked for,
// and the way of the latest requests about it through the coordinator.
import { Refusal, send } from '../cell/api.js';
import { button, el, replace } from '../page/dom.js';
import { dateAndTime, number, spoken } from '../page/words.js';
import { refusalView } from '../requests/refusal_view.js';
import { planView } from './plan_view.js';
import { row, table } from './plan_tables.js';

export class DecisionView {
  constructor(task) {
    this.task = task;
    this.box = el('div', { role: 'status' });
    this.root = el('section', {}, el('h2', {}, 'Why here'),
      el('p', { class: 'actions' }, button('Show how it was decided', () => this.read())), this.box);
  }

  async read() {
    const views = await Promise.all([
      this.ask('task_placement_query', 'task', decision), this.ask('request_trace_query', 'subject', traces)]);
    replace(this.box, ...views);
  }

  async ask(type, member, view) {
    try {
      return view(await send(JSON.stringify({ type, [member]: this.task })));
    } catch (problem) {
      return el('p', { class: 'soft' }, problem.message);
    }
  }
}

function decision({ decided_unix_ms, plan, refusal }) {
  return el('div', {}, el('p', { class: 'soft' }, `Decided ${dateAndTime(decided_unix_ms)}; a new plan may look different now.`),
    plan ? planView(plan) : refusalView(new Refusal(refusal.error)));
}

function traces({ requests }) {
  return requests.reverse().map((x) => el('details', {}, el('summary', {}, traceWords(x)),
    table('The way of the request', ['After', 'Took', 'Handler', 'Asked', 'Of the node', ''], x.hops.flatMap(hopRows))));
}

function traceWords({ request, came_unix_ms, span_us, refusal }) {
  const end = span_us === undefined ? 'is worked on' : `${refusal ? `refused: ${spoken(refusal)}` : 'done'} after ${span(span_us)}`;
  return `${spoken(request)}, ${dateAndTime(came_unix_ms)}, ${end}`;
}

function hopRows(hop) {
  return [row(span(hop.begin_us), span(hop.span_us), hop.handler, '', '', hop.dropped ? `and ${hop.dropped} questions more` : ''),
    ...hop.asked.map((x) => row(span(x.begin_us), span(x.span_us), '', x.actor, x.node ?? '',
      x.span_us === undefined ? 'no answer' : x.refused ? 'refused' : ''))];
}

function span(us) {
  if (us === undefined)
    return '–';
  return us < 1e6 ? `${number(us / 1000, 2)} ms` : `${number(us / 1e6, 2)} s`;
}
