// The fields of one request, and what they change in its JSON, which may say more.
import { el, freshId, keyed } from '../page/dom.js';
import { clearFields, field, markFields } from '../planning/field.js';
import { choicesOf, setField, shownIn } from './catalogue.js';

export class RequestForm {
  /** `document()` gives what the JSON says, or null if it cannot be read; `onDocument` gets it changed. */
  constructor(app, request, query, document, onDocument) {
    this.app = app;
    this.document = document;
    this.onDocument = onDocument;
    this.fields = request.fields.map((about) => this.makeField(about, query.get(about.name)));
    this.root = el('form', { class: 'fields', on: { submit: (event) => event.preventDefault() } },
      this.fields.map((x) => x.root),
      request.fields.length === 0 ? el('p', { class: 'soft' }, 'It has no fields; the JSON can be changed.') : null);
    this.showChoices();
  }

  makeField(about, given) {
    const made = { about, list: el('datalist', { id: freshId('choices') }) };
    made.input = this.makeInput(about, given, made.list.id, () => this.tell([made]));
    made.root = field(`/${about.name}`, `${about.label}${about.required ? ' (needed)' : ''}`, made.input, about.about);
    made.root.classList.add(about.kind);
    made.root.append(made.list);
    return made;
  }

  makeInput({ kind, choices, start, whole, required }, given, list, tell) {
    if (kind === 'flag')
      return el('input', { type: 'checkbox', checked: given === 'true' || (given === null && start), on: { change: tell } });
    if (kind === 'choice')
      return el('select', { on: { change: tell } }, el('option', { value: '' }, 'as it is by default'), choices.map((x) => el('option', {}, x)));
    return el('input', { list, value: given ?? '', type: kind === 'number' ? 'number' : 'text', step: whole ? 1 : 'any',
      required, autocomplete: 'off', on: { input: tell } });
  }

  /** The JSON was written by hand: the fields say what it says. */
  show(document) {
    for (const { about, input } of this.fields)
      input[about.kind === 'flag' ? 'checked' : 'value'] = shownIn(document, about);
  }

  showChoices() {
    for (const { about, list } of this.fields)
      keyed(list, choicesOf(about, this.app.store), (x) => x, (x) => el('option', { value: x }));
  }

  /** What else was written into the JSON stays there. */
  tell(fields = this.fields) {
    clearFields(this.root);
    const document = this.document();
    if (document === null)
      return this.mark(fields.map(({ about }) => ({ where: `/${about.name}`, words: 'Not taken over: the JSON cannot be read.' })));
    for (const { about, input } of fields)
      setField(document, about, about.kind === 'flag' ? input.checked : input.value);
    this.onDocument(document);
  }

  mark(places) {
    markFields(this.root, places);
  }
}
