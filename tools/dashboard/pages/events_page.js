// What happens, as it happens, with filters. The newest 2000 events are kept in
// the page, 100 of them shown at once.
import { MOST_EVENTS } from '../cell/store.js';
import { button, el, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { Pager } from '../page/table.js';
import { EventRows, kindOfEvent, textOfEvent, topicOfEvent } from './event_rows.js';
import { SearchField } from './search_field.js';

const PAGE = 100;
const TOPICS = ['nodes', 'tasks', 'instances', 'cells'];

export class EventsPage {
  constructor(app, where) {
    this.app = app;
    this.page = 0;
    this.held = null;
    const draw = onceAFrame(() => this.draw());
    this.find = new SearchField('event, name, reason …', draw, where.query.get('find'));
    this.topics = TOPICS.map((topic) => el('input', { type: 'checkbox', checked: true, value: topic, on: { change: draw } }));
    this.problem = el('input', { type: 'checkbox', on: { change: draw } });
    this.hold = button('Hold', () => this.toggle(), { 'aria-pressed': 'false' });
    this.amount = el('span', { class: 'soft' });
    this.rows = new EventRows(PAGE);
    this.pager = new Pager((step) => { this.page += step; this.draw(); });
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Events'),
      el('p', { class: 'filters' }, this.find.parts,
        this.topics.map((box) => el('label', { class: 'check' }, box, box.value)),
        el('label', { class: 'check' }, this.problem, 'only problems'), this.hold, this.amount),
      this.rows.root, this.pager.root,
      el('p', { class: 'soft' }, `The newest ${MOST_EVENTS} events since the node started that this page has heard.`));
  }

  update(kinds) {
    if (kinds.has('events') || kinds.has('all'))
      this.draw();
  }

  /** Held rows stay where they are while somebody reads them. */
  toggle() {
    this.held = this.held ? null : [...this.app.store.events];
    this.hold.setAttribute('aria-pressed', String(Boolean(this.held)));
    this.draw();
  }

  draw() {
    const { events } = this.app.store;
    const words = this.find.words.replaceAll('_', ' ');
    const topics = new Set(this.topics.filter((x) => x.checked).map((x) => x.value));
    const shown = (this.held ?? events).filter((x) => topics.has(topicOfEvent(x))
      && (!this.problem.checked || kindOfEvent(x) !== 'good') && this.find.fits(textOfEvent(x), words)).reverse();
    this.page = Math.max(0, Math.min(this.page, Math.ceil(shown.length / PAGE) - 1));
    const from = this.page * PAGE;
    const page = shown.slice(from, from + PAGE);
    this.rows.update(page);
    this.pager.update(from, page.length, shown.length);
    const newer = this.held ? `, held; ${events.length - events.indexOf(this.held.at(-1)) - 1} newer` : '';
    setText(this.amount, `${shown.length} of ${(this.held ?? events).length}${newer}`);
  }
}
