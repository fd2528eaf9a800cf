// The picture of a task: made anew when steps, instances or nodes change, else only its
// words and marks are brought up to date.
import { el, replace, setAttribute, setText, svg } from '../page/dom.js';
import { shapePath } from '../page/marks.js';
import { address } from '../page/router.js';
import { hertz, instanceState, kindOf, milliseconds, nodeState, spoken } from '../page/words.js';
import { BOX, layOut, LINE, shortName } from './graph_layout.js';

/** It shrinks to fit a tablet; what would be smaller than this is scrolled. */
const LEAST_SCALE = 0.76;

export class GraphPicture {
  constructor(store, task) {
    this.store = store;
    this.task = task;
    this.root = el('div', { class: 'graph scroll-x', tabindex: 0, role: 'group', 'aria-label': `Steps of ${task} and what flows between them` });
  }

  update(instances) {
    const structure = JSON.stringify(instances.map(({ node, spec }) => [node, spec.instance, spec.input, spec.output]));
    if (structure !== this.structure)
      this.draw(layOut([...instances]));
    this.structure = structure;
    this.known = new Map(instances.map((x) => [x.spec.instance, x]));
    for (const work of this.updates)
      work();
  }

  draw({ width, height, columns, boxes, arrows }) {
    this.updates = [];
    const picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, width, role: 'presentation' }, arrowHead(),
      columns.map((x) => this.makeColumn(x, height)), arrows.map((x) => this.makeArrow(x)), boxes.map((x) => this.makeBox(x)));
    picture.style.minWidth = `${width * LEAST_SCALE}px`;
    replace(this.root, picture);
  }

  makeColumn({ node, x, width }, height) {
    const state = svg('tspan', { class: 'soft' });
    this.updates.push(() => {
      const row = this.store.nodes.get(node);
      const word = row ? nodeState(row) : 'unknown';
      setText(state, word === 'active' ? '' : `${spoken(word)}${row?.reason ? `: ${row.reason}` : ''}`);
    });
    return svg('g', { class: 'band' }, svg('rect', { x, y: 1, width, height: height - 2, rx: 4 }),
      svg('text', { x: x + 12, y: 21 }, svg('tspan', { class: 'node-name' }, node), ' ', state));
  }

  makeBox({ row, x, y, height, ends }) {
    const parts = { mark: svg('path', {}), stripe: svg('rect', { x, y, width: 4, height }), state: svg('tspan', {}), metrics: svg('tspan', {}), title: svg('title', {}) };
    this.updates.push(() => this.updateBox(parts, this.known.get(row.spec.instance)));
    const { step, operation, model } = row.spec;
    return svg('a', { class: 'step', href: address('instances', row.spec.instance) }, parts.title,
      svg('rect', { x, y, width: BOX.width, height, rx: 3 }), parts.stripe,
      svg('text', { x: x + 14, y: y + LINE, class: 'step-name' }, shortName(step, 28)),
      svg('text', { x: x + 14, y: y + 2 * LINE, class: 'soft' }, shortName(`${operation} / ${model}`, 34)),
      svg('g', { transform: `translate(${x + 14} ${y + 2 * LINE + 6})` }, parts.mark,
        svg('text', { x: 17, y: 10 }, parts.state, parts.metrics)),
      ends.map((end) => this.makeEnd(end, x)));
  }

  updateBox(parts, row) {
    const state = instanceState(row);
    const kind = kindOf(state);
    const metrics = this.metricsOf(row);
    setAttribute(parts.mark, 'd', shapePath(kind));
    setAttribute(parts.mark, 'class', `mark ${kind}`);
    setAttribute(parts.stripe, 'class', `stripe ${kind}`);
    setText(parts.state, spoken(state));
    const words = [metrics.latency_ms === undefined ? '' : milliseconds(metrics.latency_ms), metrics.dropped ? `${metrics.dropped} dropped` : ''];
    setText(parts.metrics, words.filter(Boolean).map((x) => ` · ${x}`).join(''));
    setText(parts.title, `${row.spec.step}: ${spoken(state)} on ${row.node}. ${row.reason ?? row.health_reason ?? metrics.remark ?? ''}`);
  }

  /** One stream; of one that goes out also how much, and how old it is. */
  makeEnd({ stream, reads, y, box }, x) {
    const metrics = svg('tspan', { class: 'metrics' });
    if (!reads)
      this.updates.push(() => {
        const { rate_hz, age_ms } = this.flows(box) ? this.metricsOf(box.row) : {};
        setText(metrics, [hertz(rate_hz), age_ms === undefined ? '' : `${milliseconds(age_ms)} old`].filter(Boolean).map((words) => ` ${words}`).join(','));
      });
    return svg('text', { x: x + 14, y: y + 4, class: 'end' }, svg('title', {}, `${stream.endpoint} (${stream.data_type})`),
      svg('tspan', { class: 'soft' }, reads ? 'in ' : 'out '), shortName(stream.endpoint, reads ? 27 : 17), metrics);
  }

  makeArrow({ from, to, path }) {
    const line = svg('path', { d: path, 'marker-end': 'url(#arrow-head)' });
    this.updates.push(() => setAttribute(line, 'class', `arrow ${this.flows(from.box) && this.flows(to.box) ? 'flows' : 'still'}`));
    return line;
  }

  metricsOf(row) {
    return this.store.metrics.get(row.spec.instance) ?? {};
  }

  flows({ row }) {
    const now = this.known.get(row.spec.instance);
    return now && instanceState(now) === 'running';
  }
}

function arrowHead() {
  return svg('defs', {}, svg('marker', { id: 'arrow-head', viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto' },
    svg('path', { d: 'M0 0L8 4L0 8z', class: 'arrow-head' })));
}
