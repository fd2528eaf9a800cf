// Task requests as documents: how they begin, what can be made of them.
export function emptyTask() {
  return { type: 'task_request', task: 'my-task', pipeline: [] };
}

/** A step of a skill, with the first model and an id that is not taken. */
export function newStep(descriptor, pipeline) {
  const ids = new Set(pipeline.map((x) => x.id));
  let id = descriptor.operation;
  for (let number = 2; ids.has(id); ++number)
    id = `${descriptor.operation}_${number}`;
  const step = { id, operation: descriptor.operation, model: descriptor.models[0].name };
  const before = pipeline.at(-1);
  // A step mostly reads what the one before it writes.
  step.input = before ? { from: before.id } : { endpoint: '' };
  if (descriptor.output.protocols[0] === 'file')
    step.output = { endpoint: '' };
  return step;
}

/** The plan query of a task request, with what is thought away and thought of. */
export function planQuery(request, { without = [], with: added = [], why = '' } = {}) {
  const { type, request_id, preempt, force, timeout_s, ...rest } = request;
  return {
    type: 'task_plan_query', ...rest,
    ...(preempt && preempt !== 'none' ? { preempt: true } : {}),
    ...(without.length ? { without } : {}), ...(added.length ? { with: added } : {}), ...(why ? { why } : {}),
  };
}

/** A node on paper needs all of these. */
export function paperNode({ name, like, cpu, memory_mib, disk_mib, gpu_memory_mib, labels }) {
  return {
    name, architecture: like?.architecture ?? 'amd64', unified_memory: false,
    cpu: { capacity: cpu, used: 0 }, memory_mib: { capacity: memory_mib, used: 0 }, disk_mib: { capacity: disk_mib, used: 0 },
    gpus: gpu_memory_mib > 0 ? [{ index: 0, memory_mib: { capacity: gpu_memory_mib, used: 0 } }] : [],
    labels, devices: like?.devices ?? [],
  };
}

/** "a=1, b=2" as an object. */
export function labelsOf(text) {
  return Object.fromEntries(text.split(/[\s,]+/).filter(Boolean).map((x) => {
    const at = x.indexOf('=');
    return at < 0 ? [x, ''] : [x.slice(0, at), x.slice(at + 1)];
  }));
}
