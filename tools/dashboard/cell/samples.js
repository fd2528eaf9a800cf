// The last minutes of each node's resources, kept in the page alone.
const LONGEST_MS = 10 * 60 * 1000;
const SHORTEST_MS = 60 * 1000;

export class Samples {
  constructor() {
    this.ofNode = new Map();
  }

  add(node, resources, now = Date.now()) {
    const rows = this.ofNode.get(node) ?? [];
    rows.push({ time: now, ...shares(resources) });
    this.ofNode.set(node, rows);
  }

  /** Forgets what is old, and nodes that `nodes` does not name. */
  prune(nodes, now = Date.now()) {
    for (const [node, rows] of this.ofNode) {
      while (rows.length > 0 && rows[0].time < now - LONGEST_MS)
        rows.shift();
      if (rows.length === 0 || !nodes.includes(node))
        this.ofNode.delete(node);
    }
  }

  of(node) {
    return this.ofNode.get(node) ?? [];
  }

  /** How much time a line shows: all that is known of any node, a minute at least. */
  span(now = Date.now()) {
    const first = Math.min(now, ...[...this.ofNode.values()].map((rows) => rows[0].time));
    return Math.max(SHORTEST_MS, Math.min(LONGEST_MS, now - first));
  }
}

/** Of each resource the part that is used, 0 to 1 and above where more is used than there is. */
export function shares(resources) {
  const share = (x) => (x && x.capacity > 0 ? x.used / x.capacity : 0);
  const result = {
    cpu: share(resources.cpu), memory: share(resources.memory_mib), disk: share(resources.disk_mib),
  };
  for (const gpu of resources.gpus ?? [])
    result[`gpu_${gpu.index}`] = share(gpu.memory_mib);
  return result;
}
