// A task that runs, as a request for another one: what its instances tell of it, and
// in words what they do not tell.
import { asList } from '../page/words.js';

const LIFE = ['restart', 'on_node_loss', 'health', 'safe_timeout_s', 'priority'];

/** {document, notes}: the request that would make these instances again as the task `name`. */
export function copyOf(task, rows, name) {
  const specs = specsOf(rows);
  return { document: { type: 'task_request', task: name, pipeline: specs.map(stepOf) }, notes: notesOf(task, specs) };
}

/** While a step moves it has two instances. */
function specsOf(rows) {
  const specs = new Map();
  for (const { spec, state } of rows)
    if (!specs.has(spec.step) || !['stopped', 'failed'].includes(state))
      specs.set(spec.step, spec);
  return [...specs.values()];
}

function stepOf(spec) {
  const step = { id: spec.step, operation: spec.operation, model: spec.model, deployment: spec.deployment, build: spec.skill };
  const input = asList(spec.input).map(connection);
  const output = asList(spec.output).filter((x) => !isNamedAfter(spec, x));
  for (const [side, streams] of [['input', input], ['output', output]])
    if (streams.length > 0)
      step[side] = streams.length === 1 ? streams[0] : streams;
  if (Object.keys(spec.parameters ?? {}).length > 0)
    step.parameters = spec.parameters;
  for (const name of LIFE.filter((x) => spec.life?.[x] !== undefined))
    step[name] = spec.life[name];
  return step;
}

/** What is read from another step stays read from it, and not from where the other task's step writes. */
function connection({ from, ...stream }) {
  if (!from)
    return stream;
  const output = stream.endpoint.split('/').pop();
  return { from: from.endsWith(`.${output}`) ? from : `${from}.${output}` };
}

/** A topic that nobody has named: the copy's gets another name by itself. */
function isNamedAfter({ task, step }, { endpoint }) {
  return endpoint.startsWith(`/${topicWord(task)}/${topicWord(step)}/`);
}

function topicWord(text) {
  const word = text.replace(/[^A-Za-z0-9_]/g, '_');
  return /^[A-Za-z]/.test(word) ? word : `_${word}`;
}

function notesOf(task, specs) {
  const shared = specs.flatMap((spec) => asList(spec.output).filter((x) => !isNamedAfter(spec, x))).map((x) => x.endpoint);
  return [
    `Copied from what runs of task ${task}. Which labels its steps asked of their nodes, and whether others were to be preempted, is not known there.`,
    ...shared.length === 0 ? [] : [`It writes where that task does: ${[...new Set(shared)].join(', ')}. Where both are to run, one needs other places.`],
  ];
}
