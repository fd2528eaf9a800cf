// The tasks of the cell.
import { el } from '../page/dom.js';
import { address } from '../page/router.js';
import { Table } from '../page/table.js';
import { columnsOf } from './columns.js';

export class TasksPage {
  constructor(app) {
    this.app = app;
    this.table = new Table({
      caption: 'Tasks', keyOf: (x) => x.task, href: (x) => address('tasks', x.task),
      empty: 'No task runs. Start one with “New task”.', columns: columnsOf('tasks', app),
    });
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Tasks'),
      el('p', { class: 'actions' }, el('a', { class: 'button main', href: address('plan') }, 'New task')), this.table.root);
  }

  update() {
    this.table.update([...this.app.store.tasks.values()]);
  }
}
