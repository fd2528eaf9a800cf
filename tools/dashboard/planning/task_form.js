// The form of a task: its name, its steps, and how it may push others aside.
import { button, el, replace } from '../page/dom.js';
import { choice, clearFields, field, markFields, setOrDrop, textInput } from './field.js';
import { keepingPlace } from './keep_place.js';
import { stepForm } from './step_form.js';
import { newStep } from './task_document.js';

export class TaskForm {
  /** `onChange()` is called after the document was changed here. */
  constructor(store, onChange) {
    this.store = store;
    this.changed = onChange;
    this.root = el('form', { class: 'task-form', on: { submit: (event) => event.preventDefault() } });
  }

  /** Shows a document, which the form changes in place. */
  show(document) {
    this.document = document;
    if (!Array.isArray(document.pipeline))
      document.pipeline = [];
    const skills = this.descriptors();
    keepingPlace(this.root, () => replace(this.root, this.head(),
      document.pipeline.map((step, index) => stepForm({
        step, index, pipeline: document.pipeline, skills, onChange: () => this.tell(), redo: () => this.redo(),
      })), this.adder(skills)));
  }

  /** Each operation's newest build is the last one of the list. */
  descriptors() {
    const known = new Map();
    for (const { skill } of this.store.skills)
      known.set(JSON.stringify([skill.descriptor.operation, skill.descriptor.models.map((x) => x.name)]), skill.descriptor);
    return [...known.values()];
  }

  head() {
    const { document } = this;
    return el('div', { class: 'row' },
      field('/task', 'Name of the task', textInput(document.task ?? '', (text) => { document.task = text; this.tell(); })),
      field('/preempt', 'If there is no room', choice([['', 'refuse it'], ['show', 'say what would have to end'], ['yes', 'end what is less important']],
        document.preempt ?? '', (value) => { setOrDrop(document, 'preempt', value); this.tell(); })));
  }

  adder(skills) {
    const operations = [...new Set(skills.map((x) => x.operation))].sort();
    const what = choice(operations.length ? operations : [['', 'no skill is known']], operations[0] ?? '', () => {});
    const add = button('Add a step', () => this.addStep(what.value), { disabled: operations.length === 0 });
    return el('div', { class: 'adder' }, field('/pipeline', 'Skill', what), add);
  }

  addStep(operation) {
    const { pipeline } = this.document;
    const descriptor = this.descriptors().find((x) => x.operation === operation);
    if (!descriptor)
      return;
    pipeline.push(newStep(descriptor, pipeline));
    this.redo();
    this.root.querySelectorAll('.step-form')[pipeline.length - 1]?.querySelector('input')?.focus();
  }

  redo() {
    this.show(this.document);
    this.tell();
  }

  tell() {
    clearFields(this.root);
    this.changed();
  }

  mark(places) {
    markFields(this.root, places);
  }
}
