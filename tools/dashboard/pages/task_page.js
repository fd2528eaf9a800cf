// One task: its picture over the nodes, its instances, what has happened to it,
// and what can be asked for it.
import { send } from '../cell/api.js';
import { GraphPicture } from '../graph/graph_picture.js';
import { button, el, replace, setText } from '../page/dom.js';
import { throttled } from '../page/frames.js';
import { stateMark, updateState } from '../page/marks.js';
import { address, way } from '../page/router.js';
import { ago, dateAndTime } from '../page/words.js';
import { DecisionView } from '../planning/decision_view.js';
import { keepDraft } from '../planning/drafts.js';
import { copyOf } from '../planning/task_copy.js';
import { EventRows } from './event_rows.js';
import { instanceTable } from './instances_page.js';

const HISTORY_MS = 1000;

export class TaskPage {
  constructor(app, where) {
    this.app = app;
    this.name = where.name;
    this.state = stateMark('unknown');
    this.about = el('p', { class: 'soft' });
    this.waits = el('ul', { class: 'waits' });
    this.picture = new GraphPicture(app.store, this.name);
    this.instances = instanceTable(app, 'TASK');
    this.history = new EventRows(200, { dates: true });
    this.dropped = el('p', { class: 'soft' });
    this.root = el('div', { class: 'page' },
      el('p', { class: 'way' }, el('a', { href: address('tasks') }, 'Tasks')),
      el('h1', {}, this.name, ' ', this.state), this.about, this.actions(), this.waits,
      el('section', {}, el('h2', {}, 'Steps over nodes'), this.picture.root),
      el('section', {}, el('h2', {}, 'Instances'), this.instances.root),
      new DecisionView(this.name).root,
      el('section', {}, el('h2', {}, 'What has happened'), this.dropped, this.history.root));
    this.newest = app.store.events.at(-1);
    this.askHistory = throttled(() => this.readHistory(), HISTORY_MS);
    this.readHistory();
  }

  actions() {
    const request = (type, words) => way(words, 'requests', type, { task: this.name });
    return el('p', { class: 'actions' }, request('task_restart', 'Restart'), request('task_termination', 'Stop'),
      button('Use as a new task', () => this.planAnew()));
  }

  update(kinds) {
    const { store } = this.app;
    const task = store.tasks.get(this.name);
    if (task) {
      updateState(this.state, task.state);
      setText(this.about, `Asked for ${dateAndTime(task.submitted_unix_ms)}, ${ago(task.submitted_unix_ms)} ago`);
    } else if (store.cell) {
      updateState(this.state, 'stopped');
      setText(this.about, 'The cell has no task of that name now.');
    }
    if (Boolean(task) !== this.there)
      this.app.metrics.request(task && { task: this.name });
    this.there = Boolean(task);
    const instances = store.instancesOf(this.name);
    this.picture.update(instances);
    this.instances.update(instances);
    this.showWaits(instances);
    if (kinds.has('events') && this.newEvents().some((x) => this.concerns(x)))
      this.askHistory();
  }

  /** Many may come with one picture. */
  newEvents() {
    const { events } = this.app.store;
    const fresh = events.slice(events.lastIndexOf(this.newest) + 1);
    this.newest = events.at(-1);
    return fresh;
  }

  concerns(event) {
    return event.subject === this.name || event.data?.task === this.name;
  }

  showWaits(instances) {
    const words = instances.filter((x) => x.waits).map((x) => `${x.spec.step}: ${x.waits}`).join('\n');
    if (words !== this.shownWaits)
      replace(this.waits, words.split('\n').filter(Boolean).map((text) => el('li', {}, text)));
    this.shownWaits = words;
  }

  async readHistory() {
    try {
      const story = await send(JSON.stringify({ type: 'task_history_query', task: this.name }));
      this.history.update(story.events.reverse());
      setText(this.dropped, story.dropped ? `${story.dropped} events between the first and the newest are not kept.` : '');
    } catch (problem) {
      setText(this.dropped, problem.message);
    }
  }

  planAnew() {
    const { document, notes } = copyOf(this.name, this.app.store.instancesOf(this.name), `${this.name}-2`);
    keepDraft(document, notes);
    this.app.go(address('plan'));
  }
}
