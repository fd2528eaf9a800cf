// The nodes of the cell with what is used of them, now and over the last minutes.
import { el } from '../page/dom.js';
import { meter, sparkline, stateMark, updateMeter, updateSparkline, updateState } from '../page/marks.js';
import { address } from '../page/router.js';
import { Table } from '../page/table.js';
import { mebibytes, nodeState, number } from '../page/words.js';
import { shares } from '../cell/samples.js';

export class NodeTable {
  constructor(app) {
    this.app = app;
    this.table = new Table({
      caption: 'Nodes of the cell', columns: this.columns(), keyOf: (x) => x.identity.name,
      href: (x) => address('nodes', x.identity.name), empty: 'No node is known yet.',
    });
    this.root = this.table.root;
  }

  update() {
    this.amounts = new Map();
    for (const { node } of this.app.store.instances.values())
      this.amounts.set(node, (this.amounts.get(node) ?? 0) + 1);
    this.table.update([...this.app.store.nodes.values()]);
  }

  columns() {
    const amount = (x) => this.amounts.get(x.identity.name) ?? 0;
    return [
      { title: 'Node', order: (x) => x.identity.name, text: (x) => x.identity.name },
      { title: 'State', order: nodeState, make: (cell) => cell.appendChild(stateMark('unknown')),
        update: (cell, x, mark) => updateState(mark, nodeState(x)) },
      this.resource('CPU', 'cpu', ({ cpu }) => `${number(cpu.used, 2)} of ${number(cpu.capacity)}`),
      this.resource('Memory', 'memory', (x) => ofMebibytes(x.memory_mib)),
      { ...this.resource('Disk', 'disk', (x) => ofMebibytes(x.disk_mib), false), class: 'minor' },
      { title: 'GPU', class: 'minor', text: (x) => gpuWords(x.resources) },
      { title: 'Instances', class: 'number lesser', order: amount, text: amount },
      { title: 'Labels', class: 'minor labels', text: (x) => labelWords(x.resources.labels) },
    ];
  }

  resource(title, key, words, withLine = true) {
    return {
      title, order: (x) => shares(x.resources)[key],
      make: (cell) => {
        const parts = { meter: meter(), line: withLine ? sparkline() : null };
        cell.append(el('div', { class: 'resource' }, parts.meter.root, parts.line?.root ?? ''));
        return parts;
      },
      update: (cell, x, parts) => {
        // Instances change often, and what is used is told seldom.
        if (parts.shown === x.resources)
          return;
        parts.shown = x.resources;
        updateMeter(parts.meter, shares(x.resources)[key], words(x.resources));
        if (parts.line)
          updateSparkline(parts.line, this.app.metrics.samples.of(x.identity.name), key, this.app.metrics.samples.span());
      },
    };
  }
}

export function ofMebibytes(amount) {
  return amount.capacity >= 10240 ? `${mebibytes(amount.used)} of ${mebibytes(amount.capacity)}`
    : `${number(amount.used)} of ${number(amount.capacity)} MiB`;
}

export function labelWords(labels = {}) {
  return Object.entries(labels).map(([name, value]) => `${name}=${value}`).join('  ');
}

function gpuWords(resources) {
  if (resources.gpus.length === 0)
    return '–';
  return resources.gpus.map((x) => (x.memory_mib ? ofMebibytes(x.memory_mib) : x.name ?? 'shared memory')).join(', ');
}

/** Attributes in two columns: `attributes([['Address', element or text], ...])`. */
export function attributes(rows) {
  return el('dl', { class: 'attributes' }, rows.filter(([, value]) => value !== null && value !== undefined && value !== '' && value.length !== 0)
    .map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {}, value))));
}
