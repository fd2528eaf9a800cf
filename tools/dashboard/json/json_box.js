// A JSON document that can be read, changed and copied, with a number before each
// line and a mark at each that is wrong.
import { button, el, freshId, keyed, setAttribute, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { JsonProblem, lineOf, placeOf, placesIn } from './json_places.js';

export class JsonBox {
  /** `onDocument(document)` hears of what somebody writes here, when it is JSON. */
  constructor({ label, onDocument = () => {}, readOnly = false }) {
    const id = freshId('json');
    this.onDocument = onDocument;
    this.wrong = new Set();
    this.numbers = el('div', { class: 'numbers', 'aria-hidden': 'true' });
    this.problem = el('p', { class: 'state bad', role: 'status' });
    this.area = el('textarea', {
      id, spellcheck: 'false', autocomplete: 'off', autocapitalize: 'off', wrap: 'off', readonly: readOnly, rows: 6,
      on: { input: () => this.onInput(), scroll: () => { this.numbers.scrollTop = this.area.scrollTop; } },
    });
    this.copied = el('span', { class: 'soft', role: 'status' });
    this.root = el('div', { class: 'json' },
      el('p', { class: 'json-head' }, el('label', { for: id }, label), this.copied,
        button('Copy', () => this.copy(), { class: 'quiet' })),
      el('div', { class: 'json-body' }, this.numbers, this.area), this.problem);
    this.drawNumbers = onceAFrame(() => this.showNumbers());
  }

  get text() {
    return this.area.value;
  }

  set(document) {
    const text = JSON.stringify(document, null, 2);
    if (text === this.area.value)
      return;
    this.area.value = text;
    setText(this.problem, '');
    this.clearMarks();
  }

  onInput() {
    this.clearMarks();
    try {
      placesIn(this.text);
      setText(this.problem, '');
      this.onDocument(JSON.parse(this.text));
    } catch (problem) {
      if (!(problem instanceof JsonProblem))
        throw problem;
      const line = lineOf(this.text, problem.at);
      this.wrong.add(line);
      setText(this.problem, `Line ${line}: ${problem.message}`);
    }
  }

  clearMarks() {
    this.wrong.clear();
    this.drawNumbers();
  }

  /** Marks the lines of these JSON pointers, and gives the line of each. */
  mark(pointers) {
    const lines = pointers.map((x) => this.lineOf(x));
    this.wrong = new Set(lines);
    this.drawNumbers();
    return lines;
  }

  lineOf(pointer) {
    try {
      return lineOf(this.text, placeOf(placesIn(this.text), pointer)[0]);
    } catch {
      return 1;
    }
  }

  /** Shows the place of a pointer, selected. */
  goTo(pointer) {
    const [from, to] = placeOf(placesIn(this.text), pointer);
    this.area.focus();
    this.area.setSelectionRange(from, to);
    const lines = this.text.split('\n').length;
    this.area.scrollTop = (this.area.scrollHeight / lines) * (lineOf(this.text, from) - 4);
  }

  showNumbers() {
    const lines = this.text.split('\n').length;
    setAttribute(this.area, 'rows', Math.max(6, Math.min(34, lines + 1)));
    keyed(this.numbers, Array.from({ length: lines }, (_, index) => index + 1), (x) => x,
      (x) => el('div', {}, x), (line, x) => setAttribute(line, 'class', this.wrong.has(x) ? 'wrong' : null));
    this.numbers.scrollTop = this.area.scrollTop;
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.text);
    } catch {
      // Without the clipboard's permission the old way is left.
      this.area.select();
      document.execCommand('copy');
    }
    setText(this.copied, 'Copied.');
    setTimeout(() => setText(this.copied, ''), 2000);
  }
}
