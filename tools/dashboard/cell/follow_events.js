// What an event changes. Most say all that there is to know, and the row is
// changed here; of the others the program says which answers they make old
// (described.js), and these are asked for again.
import { STALE } from '../described.js';

/** Fields of an instance's row that `instance_changed` tells; absent means none. */
const TOLD = ['reason', 'exit_code', 'restarts', 'next_start_unix_ms', 'health', 'health_reason', 'waits'];

export function applyEvent(store, event, ask) {
  if (event.event === 'instance_changed')
    return onInstanceChanged(store, event, ask);
  if (event.event === 'node_lost')
    onNodeLost(store, event);
  if (event.event === 'task_terminated')
    store.endTask(event.subject);
  for (const answer of staleAfter(event.event))
    answer === 'task' ? onTaskFact(store, event, ask) : ask(answer);
}

/** The first that fits counts; a name with a * stands for all that begin so. */
function staleAfter(event) {
  const fits = ([name]) => (name.endsWith('*') ? event.startsWith(name.slice(0, -1)) : name === event);
  return STALE.find(fits)?.[1] ?? [];
}

function onTaskFact(store, event, ask) {
  const task = event.data?.task ?? event.subject;
  if (event.event === 'allocation_chosen' || event.event === 'task_accepted')
    store.ended.delete(task);
  askForTask(store, task, ask);
}

/** Who asks for a task that is gone is refused, and the refusal is an event for everybody. */
function askForTask(store, task, ask) {
  if (task && !store.ended.has(task))
    ask('task', task);
}

function onInstanceChanged(store, event, ask) {
  const { data = {} } = event;
  // The same is told again with its node, and says more.
  if (data.node === undefined && store.me?.role === 'coordinator')
    return;
  const row = store.instances.get(event.subject);
  const moved = row && data.node !== undefined && data.node !== row.node;
  if (!row || moved)
    return askForTask(store, data.task, ask);
  for (const name of TOLD)
    row[name] = data[name];
  if (row.state !== data.state)
    row.since_unix_ms = event.time_unix_ms;
  row.state = data.state;
  delete row.unknown_since_unix_ms;
  deriveTaskState(store.tasks.get(row.spec.task), store);
  store.flights.note('task', row.spec.task);
  store.touch('instances', 'tasks');
}

/** At once, so that nobody looks at a dead node as if it lived; the rest is asked for. */
function onNodeLost(store, event) {
  const row = store.nodes.get(event.subject);
  if (!row)
    return;
  row.state = 'lost';
  row.reason = event.data?.reason;
  row.since_unix_ms = event.time_unix_ms;
  for (const instance of store.instancesOn(event.subject)) {
    instance.unknown_since_unix_ms = event.time_unix_ms;
    deriveTaskState(store.tasks.get(instance.spec.task), store);
  }
  store.touch('nodes', 'instances', 'tasks');
}

/** Between the events of the task itself its state follows from its instances. */
function deriveTaskState(task, store) {
  if (!task || !['running', 'degraded'].includes(task.state))
    return;
  const well = (x) => (x.state === 'running' && !x.unknown_since_unix_ms && (x.health ?? 'good') === 'good')
    || (x.state === 'stopped' && x.exit_code === 0);
  task.state = store.instancesOf(task.task).every(well) ? 'running' : 'degraded';
}
