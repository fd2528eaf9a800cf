// What an event changes. Most say all that there is to know, and the row is
// changed here; the others name the one question that has to be asked again.

/** Fields of an instance's row that `instance_changed` tells; absent means none. */
const TOLD = ['reason', 'exit_code', 'restarts', 'next_start_unix_ms', 'health', 'health_reason', 'waits'];

const QUESTIONS = {
  node_joined: ['cell', 'cells', 'skills'], node_left: ['cell', 'cells', 'skills'],
  node_lost: ['cell', 'cells', 'skills'], node_departing: ['cell'], transfer_ended: ['cell', 'cells'],
  node_draining: ['cell'], node_drained: ['cell'], node_undrained: ['cell'],
  node_appeared: ['cell'], node_vanished: ['cell'],
  peer_joined: ['cells'], peer_changed: ['cells'], peer_lost: ['cells'], peer_vanished: ['cells'],
  peer_unreachable: ['cells'], cell_name_conflict: ['cells'], cells_rebalanced: ['cell', 'cells'],
  skill_refused: ['skills'], cell_joined: ['cell', 'cells', 'node'], cell_left: ['cell', 'cells', 'node'],
  coordinator_lost: ['node'],
};

/** Steps that begin, end or go elsewhere: the task has to be read again. */
const TASK_FACTS = new Set([
  'task_accepted', 'task_finished', 'task_failed', 'allocation_chosen', 'instance_moved',
  'instance_restarted', 'instance_awaited', 'instance_out_of_reach', 'step_stranded',
]);

export function applyEvent(store, event, ask) {
  for (const question of QUESTIONS[event.event] ?? [])
    ask(question);
  if (event.event === 'instance_changed')
    onInstanceChanged(store, event, ask);
  else if (event.event === 'node_lost')
    onNodeLost(store, event);
  else if (event.event === 'task_terminated')
    store.endTask(event.subject);
  else if (TASK_FACTS.has(event.event))
    onTaskFact(store, event, ask);
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
