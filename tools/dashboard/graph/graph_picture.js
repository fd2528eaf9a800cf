// The picture of a task: made anew when steps, instances or nodes change, else only its
// words and marks are brought up to date.
import { el, replace, setAttribute, setText, svg } from '../page/dom.js';
import { shapePath } from '../page/marks.js';
import { address } from '../page/router.js';
import { hertz, instanceState, kindOf, milliseconds, nodeState, spoken } from '../page/words.js';
import { labelHeight, layOut } from './graph_layout.js';
import { shortName, taskGraph } from './task_graph.js';

/** It shrinks to fit a tablet; what would be smaller than this is scrolled. */
const LEAST_SCALE = 0.76;

export class GraphPicture {
  constructor(store, task) {
    this.store = store;
    this.task = task;
    this.root = el('div', { class: 'graph scroll-x', tabindex: 0, role: 'group', 'aria-label': `Steps of ${task} and what flows between them` });
  }

  update(instances) {
    const graph = taskGraph(instances);
    const structure = JSON.stringify([graph.flows, graph.ends, graph.steps.map((x) => [x.id, x.node, x.row.spec.instance])]);
    if (structure !== this.structure)
      this.draw(graph);
    this.structure = structure;
    for (const row of instances)
      this.updateStep(row);
    for (const arrow of this.layout.arrows)
      this.updateArrow(arrow);
    this.layout.bands.forEach((band) => this.updateBand(band));
  }

  draw(graph) {
    this.layout = layOut(graph);
    this.boxes = new Map();
    this.arrows = new Map();
    this.bands = new Map();
    const { width, height, bands, items, arrows } = this.layout;
    const picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, width, role: 'presentation' },
      arrowHead(),
      bands.map((x) => this.makeBand(x, width)),
      arrows.map((x) => this.makeArrow(x)),
      items.map((x) => (x.kind === 'step' ? this.makeStep(x) : makeEnd(x))),
      arrows.filter((x) => x.labelled).map((x) => this.makeLabel(x)));
    picture.style.minWidth = `${width * LEAST_SCALE}px`;
    replace(this.root, picture);
  }

  makeBand(band, width) {
    const state = svg('tspan', { class: 'soft' });
    this.bands.set(band.node, { state });
    return svg('g', { class: 'band' },
      svg('rect', { x: 1, y: band.y, width: width - 2, height: band.height, rx: 4 }),
      svg('text', { x: 14, y: band.y + 19 }, svg('tspan', { class: 'node-name' }, band.node), ' ', state));
  }

  updateBand(band) {
    const row = this.store.nodes.get(band.node);
    const state = row ? nodeState(row) : 'unknown';
    setText(this.bands.get(band.node).state, state === 'active' ? '' : `${spoken(state)}${row?.reason ? `: ${row.reason}` : ''}`);
  }

  makeStep({ x, y, width, height, step }) {
    const parts = {
      mark: svg('path', {}), state: svg('tspan', {}), metrics: svg('tspan', {}), title: svg('title', {}),
    };
    parts.box = svg('rect', { x, y, width, height, rx: 3 });
    parts.stripe = svg('rect', { x, y, width: 4, height });
    this.boxes.set(step.row.spec.step, parts);
    return svg('a', { class: 'step', href: address('instances', step.row.spec.instance) }, parts.title, parts.box, parts.stripe,
      svg('text', { x: x + 14, y: y + 19, class: 'step-name' }, shortName(step.id, 22)),
      svg('text', { x: x + 14, y: y + 35, class: 'soft' }, shortName(`${step.row.spec.operation} / ${step.row.spec.model}`, 27)),
      svg('g', { transform: `translate(${x + 14} ${y + 43})` }, parts.mark,
        svg('text', { x: 17, y: 10 }, parts.state, parts.metrics)));
  }

  updateStep(row) {
    const parts = this.boxes.get(row.spec.step);
    const state = instanceState(row);
    const kind = kindOf(state);
    const metrics = this.store.metrics.get(row.spec.instance) ?? {};
    setAttribute(parts.mark, 'd', shapePath(kind));
    setAttribute(parts.mark, 'class', `mark ${kind}`);
    setAttribute(parts.stripe, 'class', `stripe ${kind}`);
    setText(parts.state, spoken(state));
    const words = [metrics.latency_ms === undefined ? '' : milliseconds(metrics.latency_ms), metrics.dropped ? `${metrics.dropped} dropped` : ''];
    setText(parts.metrics, words.filter(Boolean).map((x) => ` · ${x}`).join(''));
    setText(parts.title, `${row.spec.step}: ${spoken(state)} on ${row.node}. ${row.reason ?? row.health_reason ?? metrics.remark ?? ''}`);
  }

  makeArrow(arrow) {
    const line = svg('path', { d: arrow.path, 'marker-end': 'url(#arrow-head)' });
    this.arrows.set(arrow.key, { line });
    return line;
  }

  makeLabel(arrow) {
    const height = labelHeight(arrow);
    const top = arrow.label.y - height / 2;
    const metrics = svg('text', { x: arrow.label.x, y: top + height - 4, class: 'metrics' });
    this.arrows.get(arrow.key).metrics = metrics;
    return svg('g', { class: 'flow' },
      streamTitle(arrow.streams),
      svg('rect', { x: arrow.label.x - 76, y: top, width: 152, height: height + 2, rx: 3 }),
      lines(arrow.streams).map((words, index) => svg('text', { x: arrow.label.x, y: top + 12 + 15 * index }, words)),
      metrics);
  }

  updateArrow({ key, from, to }) {
    const parts = this.arrows.get(key);
    const writer = from.step && this.store.instances.get(from.step.row.spec.instance);
    const reader = to.step && this.store.instances.get(to.step.row.spec.instance);
    const flows = [[from, writer], [to, reader]].every(([end, row]) => !end.step || row && instanceState(row) === 'running');
    setAttribute(parts.line, 'class', `arrow ${flows ? 'flows' : 'still'}`);
    const metrics = this.store.metrics.get(writer?.spec.instance) ?? {};
    const words = [hertz(metrics.rate_hz), timeWords(metrics)].filter(Boolean);
    if (parts.metrics)
      setText(parts.metrics, flows ? words.join(' · ') || 'no metrics' : 'nothing flows');
  }
}

/** How old it is at the output, or if that is not known how long the step takes. */
function timeWords({ age_ms, latency_ms }) {
  if (age_ms !== undefined)
    return `${milliseconds(age_ms)} old`;
  return latency_ms === undefined ? '' : `takes ${milliseconds(latency_ms)}`;
}

function streamTitle(streams) {
  return svg('title', {}, streams.map((x) => `${x.endpoint} (${x.data_type})`).join('\n'));
}

function lines(streams) {
  if (streams.length <= 3)
    return streams.map((x) => shortName(x.endpoint, 23));
  return [...streams.slice(0, 2).map((x) => shortName(x.endpoint, 23)), `and ${streams.length - 2} more`];
}

function makeEnd({ x, y, width, height, end }) {
  return svg('g', { class: 'end' },
    streamTitle(end.streams),
    svg('rect', { x, y, width, height, rx: height / 2 > 20 ? 12 : height / 2 }),
    lines(end.streams).map((words, index) => svg('text', { x: x + width / 2, y: y + 18 + 15 * index }, words)));
}

function arrowHead() {
  return svg('defs', {}, svg('marker', { id: 'arrow-head', viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto' },
    svg('path', { d: 'M0 0L8 4L0 8z', class: 'arrow-head' })));
}
