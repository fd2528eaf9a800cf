// Instances with their states and metrics, of the cell, a node or a task.
import { stateMark, updateState } from '../page/marks.js';
import { setAttribute, setText } from '../page/dom.js';
import { address } from '../page/router.js';
import { Table } from '../page/table.js';
import { ago, hertz, instanceState, mebibytes, milliseconds, number } from '../page/words.js';

export class InstanceTable {
  constructor(app, { without = '' } = {}) {
    this.app = app;
    this.table = new Table({
      caption: 'Instances', columns: this.columns().filter((x) => x.key !== without),
      keyOf: (x) => x.spec.instance, href: (x) => address('instances', x.spec.instance),
      empty: 'None.',
    });
    this.root = this.table.root;
  }

  update(rows) {
    this.table.update(rows);
  }

  columns() {
    const metrics = (x) => this.app.store.metrics.get(x.spec.instance) ?? x.figures ?? {};
    const count = (x) => number(x, 9);
    const figure = (title, of, words, rank = '') => ({
      title, class: `number${rank}`, order: (x) => of(metrics(x)) ?? -1, text: (x) => words(of(metrics(x))),
    });
    return [
      { title: 'Step', order: (x) => `${x.spec.task} ${x.spec.step}`,
        update: (cell, x) => setText(cell, x.spec.step) },
      { title: 'Task', key: 'task', order: (x) => x.spec.task, text: (x) => x.spec.task },
      { title: 'State', order: instanceState, make: (cell) => cell.appendChild(stateMark('unknown')),
        update: (cell, x, mark) => {
          updateState(mark, instanceState(x));
          setAttribute(mark, 'title', x.reason ?? x.health_reason ?? metrics(x).remark ?? null);
        } },
      { title: 'Node', key: 'node', order: (x) => x.node, text: (x) => x.node },
      { title: 'Skill', class: 'minor', order: (x) => x.spec.operation, text: (x) => `${x.spec.operation} / ${x.spec.model}` },
      figure('Rate', (x) => x.rate_hz, hertz),
      figure('Latency', (x) => x.latency_ms, milliseconds),
      figure('Memory', (x) => x.use?.memory_mib, mebibytes),
      figure('Cores', (x) => x.use?.cpu, number, ' minor'),
      figure('Frames', (x) => x.frames, count, ' minor'),
      figure('Dropped', (x) => x.dropped, count, ' minor'),
      { title: 'Restarts', class: 'number minor', order: (x) => x.restarts ?? 0, text: (x) => x.restarts || '' },
      { title: 'Since', class: 'number', order: (x) => -x.since_unix_ms, text: (x) => ago(x.since_unix_ms) },
    ];
  }
}
