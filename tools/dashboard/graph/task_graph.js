// The steps of a task and what flows between them, from its instances: an arrow
// is there where an output of one step is the input of another.
import { asList } from '../page/words.js';

/**
 * {steps: [{id, node, row}], flows: [{from, to, streams}], ends: [{step, side, streams}]}
 * A flow holds all streams between two steps; an end holds those that come from,
 * or go to, the outside of the task.
 */
export function taskGraph(instances) {
  const steps = instances.map((row) => ({ id: row.spec.step, node: row.node, row }));
  const written = new Map();
  for (const step of steps)
    for (const stream of asList(step.row.spec.output))
      add(written, keyOf(stream), step.id);
  const flows = new Map();
  const ends = new Map();
  const read = new Set();
  for (const step of steps)
    for (const stream of asList(step.row.spec.input)) {
      read.add(keyOf(stream));
      const writers = (written.get(keyOf(stream)) ?? []).filter((x) => x !== step.id);
      for (const from of writers)
        add(flows, `${from} ${step.id}`, stream, { from, to: step.id });
      if (writers.length === 0)
        add(ends, `in ${step.id}`, stream, { step: step.id, side: 'in' });
    }
  for (const step of steps)
    for (const stream of asList(step.row.spec.output))
      if (!read.has(keyOf(stream)))
        add(ends, `out ${step.id}`, stream, { step: step.id, side: 'out' });
  return { steps, flows: gathered(flows), ends: gathered(ends) };
}

export function keyOf(stream) {
  return `${stream.protocol} ${stream.endpoint}`;
}

function add(map, key, stream, about) {
  const list = map.get(key) ?? map.set(key, Object.assign([], { about })).get(key);
  list.push(stream);
}

function gathered(map) {
  return [...map.values()].map((streams) => ({ ...streams.about, streams: [...streams] }));
}

/** The last words of an endpoint: what tells it from its siblings. */
export function shortName(endpoint, most = 24) {
  if (endpoint.length <= most)
    return endpoint;
  const words = endpoint.split('/');
  let text = words.pop();
  while (words.length > 0 && text.length + words.at(-1).length + 2 < most)
    text = `${words.pop()}/${text}`;
  return text.length + 2 > most ? `…${text.slice(-(most - 1))}` : `…/${text}`;
}
