// Parts of a plan as tables: allocations, what is used, candidates that do not fit.
import { el, svg } from '../page/dom.js';
import { address } from '../page/router.js';
import { number, percent } from '../page/words.js';

export function table(caption, heads, rows) {
  return el('div', { class: 'scroll-x' }, el('table', {}, el('caption', { class: 'sr' }, caption),
    el('thead', {}, el('tr', {}, heads.map((x) => el('th', { scope: 'col' }, x)))), el('tbody', {}, rows)));
}

export const row = (...cells) => el('tr', {}, cells.map((x, index) => el(index === 0 ? 'th' : 'td', { scope: index === 0 ? 'row' : null }, x)));

export function allocationTable(allocations) {
  const share = (x) => (x === undefined ? '' : percent(x));
  return table('Where each step goes', ['Step', 'Node', 'Deployment', 'CPU', 'Memory', 'Disk', 'GPU', 'Variance', 'Bonus'],
    allocations.map((x) => row(x.step, x.node, x.deployment, share(x.fractions.cpu), share(x.fractions.memory), share(x.fractions.disk),
      x.gpu === null ? '–' : `${x.gpu}: ${share(x.fractions.gpu_memory)}`, number(x.variance), number(x.bonus))));
}

/** Candidates with the same reasons stand in one row. */
export function rejectedTable(rejected) {
  const groups = new Map();
  for (const x of rejected) {
    const key = JSON.stringify([x.step, x.deployment, x.reasons]);
    const group = groups.get(key) ?? { ...x, nodes: [] };
    group.nodes.push(x.gpu === undefined || x.gpu === null ? x.node : `${x.node} GPU ${x.gpu}`);
    groups.set(key, group);
  }
  return table('Candidates that do not fit', ['Step', 'Nodes', 'Deployment', 'Why not'],
    [...groups.values()].map((x) => row(x.step, x.nodes.join(', '), x.deployment, x.reasons.join('; '))));
}

export function useTable(use) {
  return table('What is used', ['Node', 'Resource', 'Before and after', 'Used', 'Of'],
    use.map((x) => row(x.node, x.resource.replace('_', ' '), useBar(x), `${number(x.before)} → ${number(x.after)}`, number(x.capacity))));
}

function useBar({ capacity, before, after }) {
  const scale = (x) => (capacity > 0 ? Math.max(0, Math.min(1, x / capacity)) * 100 : 0);
  const part = (name, from, to) => svg('rect', { class: name, x: scale(from), y: 0, width: scale(to) - scale(from), height: 8 });
  return svg('svg', { class: 'bar use', viewBox: '0 0 100 8', preserveAspectRatio: 'none', 'aria-hidden': 'true' },
    part('ground', 0, capacity), part('fill', 0, before), part('added', before, after));
}

export function preemptedList(preempted) {
  return el('ul', {}, preempted.map((x) => el('li', {}, el('a', { href: address('instances', x.instance) }, `${x.task} / ${x.step}`),
    ` on ${x.node}${x.priority === undefined ? '' : `, priority ${x.priority}`}`)));
}
