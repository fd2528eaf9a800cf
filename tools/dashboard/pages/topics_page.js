// The ROS 2 topics of the cell. No event tells of them, so they are read when the
// page is opened, when instances change, and when somebody asks.
import { get } from '../cell/api.js';
import { button, el, setText } from '../page/dom.js';
import { throttled } from '../page/frames.js';
import { Table } from '../page/table.js';
import { count } from '../page/words.js';
import { columnsOf } from './columns.js';
import { SearchField } from './search_field.js';

const AGAIN_MS = 2000;

export class TopicsPage {
  constructor(app) {
    this.app = app;
    this.find = new SearchField('topic, type, program …', () => this.draw());
    this.words = el('span', { class: 'soft', role: 'status' });
    this.table = new Table({
      caption: 'Topics', columns: columnsOf('topics', app), keyOf: (x) => `${x.topic} ${x.data_type}`, empty: 'No topic is known.',
    });
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Topics'),
      el('p', { class: 'filters' }, this.find.parts,
        button('Read again', () => this.read()), this.words),
      this.table.root);
    this.again = throttled(() => this.read(), AGAIN_MS);
    this.read();
  }

  update(kinds) {
    if (kinds.has('instances'))
      this.again();
  }

  async read() {
    try {
      this.app.store.topics = (await get('topics')).topics;
      this.problem = '';
    } catch (problem) {
      this.problem = problem.message;
    }
    this.draw();
  }

  draw() {
    const rows = this.app.store.topics.filter((x) => this.find.fits(JSON.stringify(x).toLowerCase()));
    this.table.update(rows);
    setText(this.words, this.problem || count(rows.length, 'topic'));
  }
}
