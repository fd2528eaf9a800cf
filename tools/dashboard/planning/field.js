// One labelled control of a form, with room for what is wrong with it.
import { el, freshId } from '../page/dom.js';

/** `where` is the JSON pointer of what it says; marks of a refusal find it by that. */
export function field(where, label, control, about = '') {
  const wrong = el('span', { class: 'field-wrong', id: freshId('wrong') });
  control.id ||= freshId('field');
  control.setAttribute('aria-describedby', wrong.id);
  return el('div', { class: 'field', 'data-where': where }, el('label', { for: control.id }, label), control,
    about ? el('span', { class: 'soft about' }, about) : null, wrong);
}

export function textInput(value, onInput, more = {}) {
  return el('input', { type: 'text', autocomplete: 'off', spellcheck: 'false', value, ...more, on: { input: (event) => onInput(event.target.value) } });
}

export function choice(options, value, onChange) {
  const select = el('select', { on: { change: () => onChange(select.value) } },
    options.map((x) => {
      const [word, label] = Array.isArray(x) ? x : [x, x];
      return el('option', { value: word, selected: word === value }, label);
    }));
  return select;
}

/** Sets a member, or takes it out where the value says nothing. */
export function setOrDrop(object, name, value) {
  if (value === '' || value === undefined)
    delete object[name];
  else
    object[name] = value;
}

/** Marks the places of a refusal in the form `root`; what is nearest around a place gets the mark. */
export function markFields(root, places) {
  clearFields(root);
  let first = null;
  for (const { where, words } of places) {
    const found = nearest(root, where);
    if (!found)
      continue;
    found.querySelector('input, select, textarea')?.setAttribute('aria-invalid', 'true');
    found.querySelector('.field-wrong').textContent = words;
    found.closest('details')?.setAttribute('open', '');
    first ??= found;
  }
  first?.scrollIntoView({ block: 'nearest' });
}

export function clearFields(root) {
  for (const wrong of root.querySelectorAll('.field-wrong'))
    wrong.textContent = '';
  for (const control of root.querySelectorAll('[aria-invalid]'))
    control.removeAttribute('aria-invalid');
}

function nearest(root, where) {
  const fields = [...root.querySelectorAll('.field[data-where]')];
  for (let place = where; place; place = place.slice(0, place.lastIndexOf('/'))) {
    const found = fields.find((x) => x.dataset.where === place) ?? fields.find((x) => x.dataset.where.startsWith(`${place}/`));
    if (found)
      return found;
  }
  return null;
}
