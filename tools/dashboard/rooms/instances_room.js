// All instances of the cell, with filters.
import { el, freshId, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { count, instanceState, kindOf } from '../page/words.js';
import { InstanceTable } from './instance_table.js';

const GROUPS = [
  ['', 'every state'], ['good', 'running'], ['busy', 'on their way'], ['warn', 'in trouble'],
  ['bad', 'failed'], ['off', 'stopped'], ['unknown', 'not known'],
];

export class InstancesRoom {
  constructor(app, where) {
    this.app = app;
    const draw = onceAFrame(() => this.update());
    const find = freshId('find');
    const group = freshId('group');
    this.find = el('input', { type: 'search', id: find, placeholder: 'task, step, node, skill …', value: where.query.get('find') ?? '', on: { input: draw } });
    this.group = el('select', { id: group, on: { change: draw } }, GROUPS.map(([kind, words]) => el('option', { value: kind }, words)));
    this.amount = el('span', { class: 'soft', role: 'status' });
    this.table = new InstanceTable(app);
    this.root = el('div', { class: 'room' }, el('h1', {}, 'Instances'),
      el('p', { class: 'filters' }, el('label', { for: find }, 'Find'), this.find,
        el('label', { for: group }, 'State'), this.group, this.amount),
      this.table.root);
    app.figures.wish('instances');
  }

  update() {
    const words = this.find.value.toLowerCase().split(/\s+/).filter(Boolean);
    const all = [...this.app.store.instances.values()];
    const shown = all.filter((x) => (!this.group.value || kindOf(instanceState(x)) === this.group.value)
      && words.every((word) => textOf(x).includes(word)));
    this.table.update(shown);
    setText(this.amount, shown.length === all.length ? count(all.length, 'instance') : `${shown.length} of ${all.length}`);
  }
}

function textOf({ spec, node, state }) {
  return `${spec.task} ${spec.step} ${node} ${spec.operation} ${spec.model} ${state} ${spec.instance}`.toLowerCase();
}
