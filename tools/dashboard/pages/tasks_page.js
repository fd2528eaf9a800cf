// The tasks of the cell.
import { el } from '../page/dom.js';
import { stateMark, updateState } from '../page/marks.js';
import { address } from '../page/router.js';
import { Table } from '../page/table.js';
import { ago, instanceState, spoken } from '../page/words.js';

export class TasksPage {
  constructor(app) {
    this.app = app;
    this.table = new Table({
      caption: 'Tasks', keyOf: (x) => x.task, href: (x) => address('tasks', x.task),
      empty: 'No task runs. Start one with “New task”.', columns: this.columns(),
    });
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Tasks'),
      el('p', { class: 'actions' }, el('a', { class: 'button main', href: address('plan') }, 'New task')), this.table.root);
  }

  update() {
    this.table.update([...this.app.store.tasks.values()]);
  }

  columns() {
    const { store } = this.app;
    const of = (x) => store.instancesOf(x.task);
    return [
      { title: 'Task', order: (x) => x.task, text: (x) => x.task },
      { title: 'State', order: (x) => x.state, make: (cell) => cell.appendChild(stateMark('unknown')),
        update: (cell, x, mark) => updateState(mark, x.state) },
      { title: 'Steps', class: 'number', order: (x) => x.instances.length, text: (x) => x.instances.length },
      { title: 'Not running', order: (x) => notRunning(of(x)).length, text: (x) => notRunningWords(of(x)) },
      { title: 'Nodes', class: 'minor', text: (x) => [...new Set(of(x).map((one) => one.node))].join(', ') },
      { title: 'Since', class: 'number', order: (x) => -x.submitted_unix_ms, text: (x) => ago(x.submitted_unix_ms) },
    ];
  }
}

function notRunning(instances) {
  return instances.filter((x) => instanceState(x) !== 'running');
}

function notRunningWords(instances) {
  const rows = notRunning(instances);
  const words = rows.slice(0, 3).map((x) => `${x.spec.step} ${spoken(instanceState(x))}`);
  return words.join(', ') + (rows.length > 3 ? ` and ${rows.length - 3} more` : '');
}
