// A control for one parameter, by what the skill's descriptor declares of it.
import { choice, field, setOrDrop, textInput } from './field.js';

/** A plain value in a descriptor is a default, whose type the parameter has. */
export function declared(value) {
  if (value !== null && typeof value === 'object' && !Array.isArray(value) && typeof value.type === 'string')
    return value;
  const type = Array.isArray(value) ? 'array' : value === null ? 'object' : typeof value;
  return { type, default: value };
}

export function parameterField(step, name, value, where, onChange) {
  const about = declared(value);
  const set = (next) => {
    const parameters = { ...step.parameters };
    setOrDrop(parameters, name, next);
    setOrDrop(step, 'parameters', Object.keys(parameters).length > 0 ? parameters : undefined);
    onChange();
  };
  const words = [about.description, rangeWords(about)].filter(Boolean).join(' ');
  return field(`${where}/parameters/${name}`, `${name}${about.unit ? ` (${about.unit})` : ''}`,
    control(about, step.parameters?.[name], set), words);
}

function control(about, value, set) {
  const fallback = about.default === undefined ? 'not set' : `default: ${shown(about.default)}`;
  const values = about.type === 'boolean' ? [true, false] : about.values;
  if (values)
    return choice([['', fallback], ...values.map((x) => [JSON.stringify(x), String(x)])],
      value === undefined ? '' : JSON.stringify(value), (text) => set(text === '' ? undefined : JSON.parse(text)));
  if (about.type === 'integer' || about.type === 'number')
    return textInput(value ?? '', (text) => set(text === '' ? undefined : Number(text)), {
      type: 'number', step: about.type === 'integer' ? 1 : 'any', placeholder: fallback,
    });
  if (about.type === 'string')
    return textInput(value ?? '', (text) => set(text === '' ? undefined : text), { placeholder: fallback });
  // Lists and objects are written as JSON; what is none is sent as it is, and refused with its place.
  return textInput(value === undefined ? '' : JSON.stringify(value), (text) => set(text === '' ? undefined : parsed(text)), { placeholder: fallback });
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
}

function shown(value) {
  return typeof value === 'string' ? value || 'empty' : JSON.stringify(value);
}

function rangeWords({ minimum, maximum }) {
  if (minimum === undefined && maximum === undefined)
    return '';
  if (minimum === undefined)
    return `At most ${maximum}.`;
  return maximum === undefined ? `At least ${minimum}.` : `${minimum} to ${maximum}.`;
}
