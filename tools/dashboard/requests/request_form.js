// The fields of one request.
import { el, freshId, keyed, setText } from '../page/dom.js';
import { choicesOf, documentOf } from './catalogue.js';

export class RequestForm {
  constructor(app, request, query, onDocument) {
    this.app = app;
    this.request = request;
    this.onDocument = onDocument;
    this.fields = request.fields.map((field) => this.makeField(field, query.get(field.name)));
    this.root = el('form', { class: 'fields', on: { submit: (event) => event.preventDefault() } },
      this.fields.map((x) => x.root),
      request.fields.length === 0 ? el('p', { class: 'soft' }, 'It has no fields; the JSON can be changed.') : null);
    this.showChoices();
  }

  makeField(field, given) {
    const id = freshId(field.name);
    const listId = freshId('choices');
    const wrong = el('span', { class: 'field-wrong', id: freshId('wrong') });
    const tell = () => this.tell();
    let input;
    if (field.kind === 'flag')
      input = el('input', { id, type: 'checkbox', checked: given === 'true' || (given === null && field.start), on: { change: tell } });
    else if (field.kind === 'choice')
      input = el('select', { id, on: { change: tell } }, el('option', { value: '' }, 'as it is by default'), field.choices.map((x) => el('option', {}, x)));
    else
      input = el('input', { id, list: listId, value: given ?? '', type: field.kind === 'number' ? 'number' : 'text', step: field.whole ? 1 : 'any',
        required: field.required, autocomplete: 'off', 'aria-describedby': wrong.id, on: { input: tell } });
    const list = el('datalist', { id: listId });
    const root = el('div', { class: `field ${field.kind}` }, el('label', { for: id }, field.label, field.required ? el('span', { class: 'soft' }, ' (needed)') : null),
      input, list, field.about ? el('span', { class: 'soft about' }, field.about) : null, wrong);
    return { field, input, list, root, wrong };
  }

  showChoices() {
    for (const { field, list } of this.fields)
      keyed(list, choicesOf(field, this.app.store), (x) => x, (x) => el('option', { value: x }));
  }

  tell() {
    for (const { wrong, input } of this.fields) {
      setText(wrong, '');
      input.removeAttribute('aria-invalid');
    }
    const values = Object.fromEntries(this.fields.map(({ field, input }) => [field.name, field.kind === 'flag' ? input.checked : input.value]));
    this.onDocument(documentOf(this.request, values));
  }

  mark(places) {
    for (const { where, words } of places) {
      const found = this.fields.find((x) => where.split('/')[1] === x.field.name);
      if (!found)
        continue;
      found.input.setAttribute('aria-invalid', 'true');
      setText(found.wrong, words);
    }
  }
}
