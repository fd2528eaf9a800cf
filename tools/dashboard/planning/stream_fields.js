// The inputs or outputs of a step: from another step, or at an endpoint.
import { button, el, freshId } from '../page/dom.js';
import { asList } from '../page/words.js';
import { choice, field, setOrDrop, textInput } from './field.js';

const MOST = 16;

/** `side` is 'input' or 'output'; `others` are the other steps. `onShape` is called when rows come or go. */
export function streamFields({ step, side, port, others, where, onChange, onShape }) {
  const streams = asList(step[side]).map((x) => (typeof x === 'string' ? { endpoint: x } : { ...x }));
  const keep = () => {
    setOrDrop(step, side, streams.length === 0 ? undefined : streams.length === 1 ? streams[0] : streams);
    onChange();
  };
  const reshape = () => {
    keep();
    onShape();
  };
  const rows = streams.map((stream, index) => {
    const place = streams.length === 1 && !Array.isArray(step[side]) ? `${where}/${side}` : `${where}/${side}/${index}`;
    return streamRow({ stream, side, port, others, place, keep, reshape, remove: () => { add.focus(); streams.splice(index, 1); reshape(); } });
  });
  const add = button(`Add ${side === 'input' ? 'an input' : 'an output'}`, () => { streams.push({ endpoint: '' }); reshape(); }, { class: 'quiet', disabled: streams.length >= MOST });
  const id = freshId(side);
  return el('fieldset', { class: 'streams', 'data-side': side, 'aria-labelledby': id }, el('legend', { id }, side === 'input' ? 'Reads' : 'Writes'),
    rows, rows.length === 0 ? el('p', { class: 'soft' }, side === 'input' ? 'Nothing.' : 'As the skill has it: topics are named after the task and the step.') : null, add);
}

function streamRow({ stream, side, port, others, place, keep, reshape, remove }) {
  const set = (name) => (value) => {
    setOrDrop(stream, name, value);
    keep();
  };
  const parts = [];
  if (side === 'input' && others.length > 0)
    parts.push(field(`${place}/from`, 'From', sourceChoice(stream, others, reshape)));
  if (stream.from === undefined) {
    parts.push(field(`${place}/endpoint`, 'Endpoint', textInput(stream.endpoint ?? '', (text) => { stream.endpoint = text; keep(); },
      { placeholder: '/topic, /path/of/a/file, /dev/…' })));
    parts.push(field(`${place}/data_type`, 'Type', choice([['', 'by the skill'], ...known(port.data_types, stream.data_type)], stream.data_type ?? '', set('data_type'))));
    parts.push(field(`${place}/protocol`, 'Protocol', choice([['', 'by its form'], ...known(port.protocols, stream.protocol)], stream.protocol ?? '', set('protocol'))));
  }
  return el('div', { class: 'stream' }, parts, button('✕', remove, { class: 'quiet remove', 'aria-label': `Remove this ${side}` }));
}

/** What the document says stays a choice, though the skill does not name it. */
function known(words, value) {
  return value && !words.includes(value) ? [...words, value] : words;
}

function sourceChoice(stream, others, reshape) {
  const named = others.flatMap((x) => [x.id, ...asList(x.output).map((out) => (typeof out === 'string' ? out : out.endpoint) ?? '')
    .filter(Boolean).map((endpoint) => `${x.id}.${endpoint.split('/').pop()}`)]);
  const options = stream.from && !named.includes(stream.from) ? [...named, stream.from] : named;
  return choice([['', 'an endpoint'], ...options.map((x) => [x, `step ${x}`])], stream.from ?? '', (value) => {
    if (value === '') {
      delete stream.from;
      stream.endpoint = '';
    } else {
      Object.keys(stream).forEach((name) => delete stream[name]);
      stream.from = value;
    }
    reshape();
  });
}
