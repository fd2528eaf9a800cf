// States are told by a shape, a colour and a word: whoever does not see one of
// them has the others. Small pictures of metrics stand here too.
import { el, setAttribute, setText, svg } from './dom.js';
import { kindOf, percent, spoken } from './words.js';

const SHAPES = {
  good: 'M6 1.2a4.8 4.8 0 1 0 0 9.6a4.8 4.8 0 1 0 0-9.6z',
  done: 'M1.2 6.4l3.4 3.6l6.4-7.2l-1.4-1.2l-5.1 5.7l-2-2.1z',
  busy: 'M6 1a5 5 0 1 0 0 10a5 5 0 1 0 0-10zM6 2.8v6.4a3.2 3.2 0 1 1 0-6.4z',
  warn: 'M6 .8l5.6 10.2h-11.2z',
  bad: 'M2.4 .8l3.6 3.6l3.6-3.6l1.6 1.6l-3.6 3.6l3.6 3.6l-1.6 1.6l-3.6-3.6l-3.6 3.6l-1.6-1.6l3.6-3.6l-3.6-3.6z',
  off: 'M1.5 1.5h9v9h-9zM3.2 3.2v5.6h5.6v-5.6z',
  unknown: 'M6 .6l5.4 5.4l-5.4 5.4l-5.4-5.4zM6 3.1l-2.9 2.9l2.9 2.9l2.9-2.9z',
};

export function shape(kind) {
  return svg('svg', { class: `mark ${kind}`, viewBox: '0 0 12 12', 'aria-hidden': 'true' },
    svg('path', { d: SHAPES[kind], 'fill-rule': 'evenodd' }));
}

/** Path of a shape inside of another picture, 12 by 12. */
export function shapePath(kind) {
  return SHAPES[kind];
}

export function warning(words) {
  return el('p', { class: 'state warn' }, shape('warn'), el('span', {}, words));
}

/** The mark and the word of a state; `update` changes it where it stands. */
export function stateMark(state) {
  const mark = el('span', { class: 'state' }, el('span', { class: 'state-shape' }), el('span', {}));
  updateState(mark, state);
  return mark;
}

export function updateState(mark, state) {
  if (mark.shownState === state)
    return;
  mark.shownState = state;
  const kind = kindOf(state);
  setAttribute(mark, 'class', `state ${kind}`);
  mark.firstChild.replaceChildren(shape(kind));
  setText(mark.lastChild, spoken(state));
}

const WIDTH = 100;

/** How full something is: a bar, and beside it the words that say the same. */
export function meter() {
  const fill = svg('rect', { class: 'fill', x: 0, y: 0, height: 6, width: 0 });
  const bar = svg('svg', { class: 'bar', viewBox: `0 0 ${WIDTH} 6`, preserveAspectRatio: 'none', 'aria-hidden': 'true' },
    svg('rect', { class: 'ground', x: 0, y: 0, height: 6, width: WIDTH }), fill);
  const words = el('span', { class: 'meter-words' });
  return { root: el('span', { class: 'meter' }, bar, words), fill, words, bar };
}

export function updateMeter(parts, share, words) {
  setAttribute(parts.fill, 'width', Math.max(0, Math.min(1, share)) * WIDTH);
  setAttribute(parts.bar, 'class', `bar ${share >= 0.95 ? 'full' : share >= 0.8 ? 'high' : ''}`);
  setText(parts.words, words);
  setAttribute(parts.root, 'title', `${percent(share)} used`);
}

/** A line over the last minutes, drawn in steps: between two words nothing is known. */
export function sparkline(height = 20) {
  const line = svg('path', { class: 'line', 'vector-effect': 'non-scaling-stroke' });
  const area = svg('path', { class: 'area' });
  const root = svg('svg', { class: 'spark', viewBox: `0 0 ${WIDTH} ${height}`, preserveAspectRatio: 'none', 'aria-hidden': 'true' },
    area, line);
  return { root, line, area, height };
}

export function updateSparkline(parts, samples, key, windowMs, now = Date.now()) {
  const { height } = parts;
  const x = (time) => (WIDTH * (1 - (now - time) / windowMs)).toFixed(1);
  const y = (share) => (height - 1 - Math.max(0, Math.min(1, share)) * (height - 2)).toFixed(1);
  let path = '';
  for (const sample of samples.filter((x) => x[key] !== undefined))
    path += path ? `H${x(sample.time)}V${y(sample[key])}` : `M${x(sample.time)} ${y(sample[key])}`;
  setAttribute(parts.line, 'd', path ? `${path}H${WIDTH}` : 'M0 0');
  setAttribute(parts.area, 'd', path ? `${path}H${WIDTH}V${height}H${x(samples[0].time)}z` : 'M0 0');
}
