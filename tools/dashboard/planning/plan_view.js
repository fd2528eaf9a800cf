// A plan with its explanation: the score, where each step goes, what it takes
// there, and why not elsewhere.
import { button, el } from '../page/dom.js';
import { warning } from '../page/marks.js';
import { count, number } from '../page/words.js';
import { allocationTable, preemptedList, rejectedTable, useTable } from './plan_tables.js';

/** `former` is the plan before this one, to compare with; `askWhy(step)`, if given, asks for a step's best alternative. */
export function planView(plan, former, askWhy) {
  return el('div', { class: 'plan' }, scoreLine(plan, former),
    (plan.warnings ?? []).map(warning),
    plan.preempted?.length ? [el('h3', {}, 'What would be ended for it'), preemptedList(plan.preempted)] : null,
    el('h3', {}, 'Where each step goes'), allocationTable(plan.allocations), changes(plan, former), askWhy ? whyNot(plan, askWhy) : null,
    (plan.alternatives ?? []).map(alternative),
    plan.use?.length ? el('details', { open: true }, el('summary', {}, 'What is used of the nodes, before and after'), useTable(plan.use)) : null,
    plan.rejected.length ? el('details', { open: plan.rejected.length < 12 },
      el('summary', {}, `Why not elsewhere (${count(plan.rejected.length, 'candidate')})`), rejectedTable(plan.rejected)) : null);
}

function scoreLine({ score, optimal, states, cpu_floor }, former) {
  const difference = former ? score.total - former.score.total : 0;
  const compared = former && difference !== 0 ? ` (${difference > 0 ? '+' : '−'}${number(Math.abs(difference))}, ${difference > 0 ? 'worse' : 'better'} than before)` : '';
  const fact = (name, value, title) => el('div', { title }, el('dt', {}, name), el('dd', {}, value));
  return el('dl', { class: 'score' },
    fact('Score', `${number(score.total)}${compared}`, 'The less, the better'),
    fact('Balance', number(score.balance), 'How unevenly steps take what is free'),
    fact('Load', number(score.load), `Counts ${number(score.alpha)} of itself`),
    fact('Proven', optimal ? 'optimal: nothing is better' : `within ${number(score.gap)} of the best`, `Lower bound ${number(score.lower_bound)}`),
    states === undefined ? null : fact('Looked at', count(states, 'state')),
    cpu_floor ? fact('CPU', 'up to each node’s floor', 'Other programs keep the cores busy') : null);
}

function changes(plan, former) {
  if (!former)
    return null;
  const before = new Map(former.allocations.map((x) => [x.step, x.node]));
  const moved = plan.allocations.filter((x) => before.has(x.step) && before.get(x.step) !== x.node);
  return el('p', { class: 'soft' }, moved.length === 0 ? 'All steps stay where they were in the plan before.'
    : `Against the plan before: ${moved.map((x) => `${x.step} from ${before.get(x.step)} to ${x.node}`).join(', ')}.`);
}

function whyNot(plan, askWhy) {
  return el('p', { class: 'actions' }, el('span', { class: 'soft' }, 'What would the next best place cost?'),
    plan.allocations.map((x) => button(x.step, () => askWhy(x.step), { class: 'quiet' })));
}

function alternative(x) {
  const words = x.obstacle ? `There is no other place for ${x.step}: ${x.obstacle}`
    : `The next best place for ${x.step} costs ${number(x.extra)} more: ${x.allocations.map((one) => `${one.step} on ${one.node}`).join(', ')}`;
  return el('p', { class: 'alternative', role: 'status' }, words);
}
