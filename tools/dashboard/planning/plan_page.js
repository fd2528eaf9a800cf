// A new task: the form, its JSON, where it would go and why, and its start.
import { send } from '../cell/api.js';
import { button, el, replace, setText } from '../page/dom.js';
import { debounced } from '../page/frames.js';
import { shape, warning } from '../page/marks.js';
import { address } from '../page/router.js';
import { count } from '../page/words.js';
import { refusalView } from '../requests/refusal_view.js';
import { Sender } from '../requests/sender.js';
import { draftNotes, keepDraft, keptDraft } from './drafts.js';
import { preemptedList } from './plan_tables.js';
import { planView } from './plan_view.js';
import { emptyTask, planQuery } from './task_document.js';
import { TaskForm } from './task_form.js';
import { WhatIf } from './what_if.js';

const AGAIN_MS = 250;

export class PlanPage {
  constructor(app) {
    this.app = app;
    this.document = keptDraft() ?? emptyTask();
    this.form = new TaskForm(app.store, () => this.sender.box.set(keepAs(this.document)));
    this.sender = new Sender({
      label: 'The request', action: 'Start', onDocument: (document) => this.onWritten(document), onReply: (reply) => this.started(reply),
    });
    this.sender.fields = this.form;
    this.planButton = button('Plan', () => this.plan());
    this.sender.buttons.prepend(this.planButton);
    this.state = el('p', { class: 'soft', role: 'status' });
    this.result = el('div', {});
    this.whatIf = new WhatIf(app.store, debounced(() => this.plan(), AGAIN_MS));
    this.planBox = el('section', { hidden: true }, el('h2', {}, 'Plan'), this.state, el('div', { class: 'plan-and-if' }, this.result, this.whatIf.root));
    this.root = el('div', { class: 'page' }, el('h1', {}, 'New task'),
      draftNotes().map(warning),
      el('div', { class: 'form-and-json' }, this.form.root, el('div', { class: 'sticky' }, this.sender.root, this.sender.reply)), this.planBox);
    this.sender.box.set(this.document);
  }

  update(kinds) {
    // Skills come late, or change; a form that somebody writes in is not made anew for less.
    if (kinds.has('skills') || kinds.has('all'))
      this.showSkills();
    this.whatIf.update();
  }

  showSkills() {
    const skills = JSON.stringify(this.form.descriptors());
    if (this.shownSkills !== skills)
      this.form.show(this.document);
    this.shownSkills = skills;
  }

  onWritten(document) {
    if (document === null || typeof document !== 'object' || Array.isArray(document))
      return;
    this.document = keepAs(document);
    this.form.show(this.document);
  }

  async plan(why = '') {
    this.planBox.hidden = false;
    setText(this.state, 'Planning …');
    const query = planQuery(this.document, { ...this.whatIf.thoughts, why });
    try {
      const plan = await send(JSON.stringify(query));
      replace(this.result, planView(plan, this.former(plan), (step) => this.plan(step)));
      this.whatIf.update(plan.allocations);
      this.last = plan;
      setText(this.state, `Nothing was started. ${thoughtWords(query)}`);
    } catch (problem) {
      replace(this.result, refusalView(problem, this.sender.box, this.form));
      this.whatIf.update([]);
      setText(this.state, thoughtWords(query));
    }
    this.result.scrollIntoView({ block: 'nearest' });
  }

  /** Plans of the same steps can be compared. */
  former(plan) {
    const steps = (x) => x.allocations.map((one) => one.step).join(' ');
    return this.last && steps(this.last) === steps(plan) ? this.last : null;
  }

  started(reply) {
    return el('div', {}, el('p', { class: 'state good', role: 'status' }, shape('good'), el('span', {},
      el('b', {}, `Task ${reply.task} runs`), ` with ${count(reply.instances.length, 'instance')}. `, el('a', { href: address('tasks', reply.task) }, 'Look at it'))),
    reply.preempted?.length ? [el('h3', {}, 'What it has preempted'), preemptedList(reply.preempted)] : null,
    (reply.warnings ?? []).map(warning),
    (reply.refused ?? []).map((x) => warning(`${x.step} not on ${x.node}: ${x.reason}`)));
  }
}

function keepAs(document) {
  keepDraft(document);
  return document;
}

function thoughtWords({ without, with: added }) {
  const words = [];
  if (without)
    words.push(`As if ${without.join(', ')} were not there.`);
  if (added)
    words.push(`As if ${added.map((x) => x.name).join(', ')} were there.`);
  return words.join(' ');
}
