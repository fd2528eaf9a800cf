// What if a node were not there, or one more: nodes are dragged out and back, or
// sent by their buttons; each change asks for a plan anew.
import { button, el, keyed, replace, setText } from '../page/dom.js';
import { number, mebibytes } from '../page/words.js';
import { grip, makeDraggable } from './drag.js';
import { field, textInput } from './field.js';
import { labelsOf, paperNode } from './task_document.js';

export class WhatIf {
  constructor(store, onChange) {
    this.store = store;
    this.onChange = onChange;
    this.away = new Set();
    this.added = [];
    this.here = el('ul', { class: 'zone', 'aria-label': 'Nodes that are planned with' });
    this.out = el('ul', { class: 'zone out', 'aria-label': 'Nodes that are thought away' });
    this.hint = el('p', { class: 'soft' }, 'Drag a node here.');
    this.lost = el('p', { class: 'state warn', role: 'status' });
    this.form = el('div', { class: 'paper' });
    this.root = el('section', { class: 'what-if' }, el('h3', {}, 'What if'),
      el('div', { class: 'zones' }, el('div', {}, el('h4', {}, 'Planned with'), this.here),
        el('div', {}, el('h4', {}, 'Thought away'), this.out, this.hint)), this.lost, this.form);
    this.showAdder();
  }

  /** What goes into a plan query. */
  get thoughts() {
    return { without: [...this.away], with: this.added };
  }

  /** `allocations` of the newest plan: each node shows the steps that it would get. */
  update(allocations = this.allocations ?? []) {
    this.allocations = allocations;
    const nodes = [...this.store.nodes.values()].filter((x) => x.state === 'active').map((x) => x.resources);
    this.dropLost(nodes);
    const all = [...nodes, ...this.added];
    keyed(this.here, all.filter((x) => !this.away.has(x.name)), (x) => x.name, (x) => this.makeCard(x), (card, x) => this.updateCard(card, x));
    keyed(this.out, all.filter((x) => this.away.has(x.name)), (x) => x.name, (x) => this.makeCard(x), (card, x) => this.updateCard(card, x));
    this.hint.hidden = this.away.size > 0;
  }

  /** A plan is refused that thinks away who is not there. */
  dropLost(nodes) {
    const lost = [...this.away].filter((x) => !nodes.some((node) => node.name === x));
    lost.forEach((x) => this.away.delete(x));
    if (lost.length > 0)
      setText(this.lost, `Need not be thought away, for it is not there now: ${lost.join(', ')}.`);
  }

  makeCard(node) {
    const parts = {
      steps: el('span', { class: 'steps' }),
      button: button('', () => this.move(node.name, !this.away.has(node.name)), { class: 'quiet' }),
    };
    const card = el('li', { class: 'node-card', 'data-node': node.name }, grip(), el('b', {}, node.name), el('span', { class: 'soft' }, sizeWords(node)), parts.steps, parts.button);
    card.parts = parts;
    makeDraggable(card, () => [this.here, this.out], (zone) => this.move(node.name, zone === this.out));
    return card;
  }

  updateCard({ parts }, node) {
    const steps = this.allocations.filter((x) => x.node === node.name).map((x) => x.step);
    setText(parts.steps, steps.join(', '));
    const onPaper = this.added.some((x) => x.name === node.name);
    setText(parts.button, this.away.has(node.name) ? 'Bring back' : onPaper ? 'Remove' : 'Think away');
    parts.button.setAttribute('aria-label', `${parts.button.textContent} ${node.name}`);
  }

  move(name, out) {
    if (out === this.away.has(name))
      return;
    if (this.added.some((x) => x.name === name))
      this.added = this.added.filter((x) => x.name !== name);
    else if (out)
      this.away.add(name);
    else
      this.away.delete(name);
    this.update();
    // The card has gone to the other side; who used its button goes along.
    this.root.querySelector(`[data-node="${CSS.escape(name)}"] button`)?.focus();
    this.onChange();
  }

  showAdder() {
    replace(this.form, button('Think of one more node', () => this.showForm()));
  }

  showForm() {
    const like = [...this.store.nodes.values()][0]?.resources;
    const values = { name: 'spare-1', cpu: 4, memory_mib: 8192, disk_mib: 20000, gpu_memory_mib: 0, labels: '' };
    const input = (name, label, type = 'number') => field(`/with/${name}`, label,
      textInput(values[name], (text) => { values[name] = type === 'number' ? Number(text) : text; }, { type, min: 0 }));
    replace(this.form, el('div', { class: 'row' }, input('name', 'Name', 'text'), input('cpu', 'Cores'), input('memory_mib', 'Memory (MiB)'),
      input('disk_mib', 'Disk (MiB)'), input('gpu_memory_mib', 'GPU memory (MiB)'), input('labels', 'Labels (a=1, b=2)', 'text')),
    el('p', { class: 'actions' },
      button('Add it to the plan', () => this.add(paperNode({ ...values, like, labels: labelsOf(values.labels) })), { class: 'main' }),
      button('Leave it', () => this.showAdder())));
    this.form.querySelector('input').select();
  }

  add(node) {
    this.added = [...this.added.filter((x) => x.name !== node.name), node];
    this.showAdder();
    this.update();
    this.form.querySelector('button').focus();
    this.onChange();
  }
}

function sizeWords(node) {
  return `${number(node.cpu.capacity)} core${node.cpu.capacity === 1 ? '' : 's'}, ${mebibytes(node.memory_mib.capacity)}${node.gpus.length ? `, ${node.gpus.length} GPU` : ''}`;
}
