// The requests that can be made here, and what each of them says. A field that is
// left empty is left out of the document. New tasks have a page of their own.
import { setOrDrop } from '../planning/field.js';

const force = { name: 'force', kind: 'flag', label: 'End at once what is not stop-safe yet' };
const instances = {
  name: 'instances', kind: 'choice', label: 'Its instances', choices: ['refuse', 'terminate', 'reschedule'],
  about: 'refuse: the node stays while it has some; terminate: their whole tasks end; reschedule: they start elsewhere first',
};
const node = { name: 'node', kind: 'node', label: 'Node', required: true };
const task = { name: 'task', kind: 'task', label: 'Task', required: true };
const fromCell = { name: 'cell', kind: 'cell', label: 'The cell it is in', about: 'Empty: this one, or the only node of that name' };

export const REQUESTS = [
  { type: 'task_termination', title: 'Stop a task', about: 'Ends the task and removes its instances everywhere.', fields: [task, force], grave: true },
  { type: 'task_restart', title: 'Restart a task', about: 'Ends instances and starts them again on the same nodes.',
    fields: [task, { name: 'instance', kind: 'instance', label: 'Only this instance', about: 'Empty: all of them' }, force], grave: true },
  { type: 'node_drain', title: 'Drain a node', about: 'Moves every instance away from the node, which takes no new one.', fields: [node, force] },
  { type: 'node_undrain', title: 'Undrain a node', about: 'Lets the node take instances again.', fields: [node] },
  { type: 'cell_formation', title: 'Form: bring nodes in', about: 'Brings the named nodes into this cell, from none or from other cells.',
    fields: [{ name: 'members', kind: 'names', label: 'Nodes', required: true, about: 'Names, with commas between them' }, instances] },
  { type: 'node_transfer', title: 'Transfer a node', about: 'Moves a node to another cell.',
    fields: [node, { name: 'target', kind: 'otherCell', label: 'To the cell', required: true }, instances, fromCell], grave: true },
  { type: 'node_release', title: 'Release a node', about: 'Makes a node independent, until it is chosen again.', fields: [node, instances, fromCell], grave: true },
  { type: 'transfer_query', title: 'Transfers', about: 'How transfers and releases stand.', fields: [] },
  { type: 'cell_rebalance', title: 'Rebalance the cell', about: 'Looks for a better placement of what runs, and moves steps there.',
    fields: [{ name: 'dry_run', kind: 'flag', label: 'Only say what would be moved', start: true },
      { name: 'min_gain', kind: 'number', label: 'Least gain of the score' }, { name: 'most_moves', kind: 'number', label: 'Most moves', whole: true },
      force, { name: 'stop', kind: 'flag', label: 'Stop the one that goes on' }] },
  { type: '', title: 'Any other request', about: 'Whatever docs/messages.md lists, written by hand.', fields: [], start: { type: 'node_query' } },
];

/** Of a request that says nothing yet. */
export function startOf(request) {
  return request.start ?? { type: request.type };
}

export function setField(document, field, value) {
  setOrDrop(document, field.name, valueOf(field, value));
}

/** What a field shows of a document. */
export function shownIn(document, { kind, name }) {
  const value = document[name];
  if (kind === 'flag')
    return value === true;
  return Array.isArray(value) ? value.join(', ') : value ?? '';
}

function valueOf({ kind, whole, required }, value) {
  if (kind === 'flag')
    return value || '';
  if (kind === 'names')
    return String(value ?? '').split(/[\s,]+/).filter(Boolean);
  if (value === '' || value === undefined)
    return required ? '' : undefined;
  return kind === 'number' ? (whole ? Math.round(Number(value)) : Number(value)) : value;
}

/** What a field can be, of what is known of the cell. */
export function choicesOf({ kind, choices }, store) {
  const lists = {
    node: () => [...store.nodes.keys()], task: () => [...store.tasks.keys()], instance: () => [...store.instances.keys()],
    cell: () => store.cells.map((x) => x.cell), otherCell: () => store.cells.map((x) => x.cell).filter((x) => x !== store.cell?.cell),
    names: () => store.free.map((x) => x.name), choice: () => choices,
  };
  return lists[kind]?.() ?? [];
}
