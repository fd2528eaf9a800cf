// Requests to nodes and tasks: a form, the JSON that it makes, and the reply.
import { el, replace, setAttribute } from '../page/dom.js';
import { address } from '../page/router.js';
import { REQUESTS, startOf } from './catalogue.js';
import { RequestForm } from './request_form.js';
import { objectIn, Sender } from './sender.js';

export class RequestsPage {
  constructor(app, where) {
    this.app = app;
    this.request = REQUESTS.find((x) => x.type === where.name) ?? REQUESTS[0];
    if (where.name === 'other')
      this.request = REQUESTS.at(-1);
    this.sender = new Sender({
      label: 'The request', action: 'Send', grave: this.request.grave, onDocument: (document) => this.form.show(document ?? {}),
    });
    const { box } = this.sender;
    box.set(startOf(this.request));
    this.form = new RequestForm(app, this.request, where.query, () => objectIn(box.text), (document) => box.set(document));
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Requests'),
      el('div', { class: 'columns' }, this.list(),
        el('div', { class: 'request' }, el('h2', {}, this.request.title), el('p', {}, this.request.about),
          el('div', { class: 'form-and-json' }, this.form.root, this.sender.root), this.sender.reply)));
    this.form.tell();
    this.sender.fields = this.form;
  }

  list() {
    const links = REQUESTS.map((request) => {
      const link = el('a', { href: address('requests', request.type || 'other') }, request.title);
      setAttribute(link, 'aria-current', request === this.request ? 'true' : null);
      return el('li', {}, link);
    });
    return el('nav', { class: 'list', 'aria-label': 'Kinds of requests' }, el('ul', {},
      el('li', {}, el('a', { href: address('plan') }, 'Start a task')), links));
  }

  update(kinds) {
    if (['all', 'nodes', 'tasks', 'cells', 'instances'].some((x) => kinds.has(x)))
      this.form.showChoices();
  }

  close() {
    replace(this.sender.reply);
  }
}
