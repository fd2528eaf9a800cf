// An answer tells how things were when the node gave it. What an event has changed
// while it was on its way is asked for again.
export class Flights {
  constructor() {
    this.open = new Set();
  }

  /** An event has changed this, or asks for it. */
  note(kind, name) {
    for (const changes of this.open)
      changes.set(`${kind} ${name ?? ''}`, [kind, name]);
  }

  /** Does `work`, which asks and takes the answer; `again(kind, name)` is called for what has changed meanwhile. */
  async during(work, again) {
    const changes = new Map();
    this.open.add(changes);
    try {
      await work();
    } finally {
      this.open.delete(changes);
    }
    changes.forEach((change) => again(...change));
  }
}
