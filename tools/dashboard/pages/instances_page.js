// All instances of the cell, with filters.
import { el, freshId, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { address } from '../page/router.js';
import { Table } from '../page/table.js';
import { count, instanceState, kindOf } from '../page/words.js';
import { columnsOf } from './columns.js';
import { SearchField } from './search_field.js';

const GROUPS = [
  ['', 'every state'], ['good', 'running'], ['busy', 'on their way'], ['warn', 'with problems'],
  ['bad', 'failed'], ['off', 'stopped'], ['unknown', 'not known'],
];

export class InstancesPage {
  constructor(app, where) {
    this.app = app;
    const draw = onceAFrame(() => this.update());
    const group = freshId('group');
    this.find = new SearchField('task, step, node, skill …', draw, where.query.get('find'));
    this.group = el('select', { id: group, on: { change: draw } }, GROUPS.map(([kind, words]) => el('option', { value: kind }, words)));
    this.amount = el('span', { class: 'soft', role: 'status' });
    this.table = instanceTable(app);
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Instances'),
      el('p', { class: 'filters' }, this.find.parts,
        el('label', { for: group }, 'State'), this.group, this.amount),
      this.table.root);
    app.metrics.request('instances');
  }

  update() {
    const all = [...this.app.store.instances.values()];
    const shown = all.filter((x) => (!this.group.value || kindOf(instanceState(x)) === this.group.value)
      && this.find.fits(textOf(x)));
    this.table.update(shown);
    setText(this.amount, shown.length === all.length ? count(all.length, 'instance') : `${shown.length} of ${all.length}`);
  }
}

/** Of the cell, a node or a task. */
export function instanceTable(app, without) {
  return new Table({
    caption: 'Instances', columns: columnsOf('instances', app, without),
    keyOf: (x) => x.spec.instance, href: (x) => address('instances', x.spec.instance), empty: 'None.',
  });
}

function textOf({ spec, node, state }) {
  return `${spec.task} ${spec.step} ${node} ${spec.operation} ${spec.model} ${state} ${spec.instance}`.toLowerCase();
}
