// What is known of the cell. Pages read it and are told which kinds of things
// have changed, together and once a frame, however many events came.
import { onceAFrame } from '../page/frames.js';
import { Flights } from './flights.js';

export const MOST_EVENTS = 2000;
const MOST_ENDED = 200;

export class Store {
  constructor() {
    this.me = null;
    this.cell = null;
    this.nodes = new Map();
    this.tasks = new Map();
    this.instances = new Map();
    this.byNode = null;
    this.metrics = new Map();
    this.free = [];
    this.cells = [];
    this.skills = [];
    this.refusedSkills = [];
    this.cellBuilds = [];
    this.topics = [];
    this.events = [];
    this.link = { state: 'connecting', since: Date.now() };
    this.ended = new Set();
    this.flights = new Flights();
    this.listeners = new Set();
    this.changed = new Set();
    this.tell = onceAFrame(() => this.tellListeners());
  }

  /** `listener(kinds)` hears of changes until the function that is returned is called. */
  subscribe(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  touch(...kinds) {
    for (const kind of kinds)
      this.changed.add(kind);
    this.tell();
  }

  tellListeners() {
    const kinds = this.changed;
    this.changed = new Set();
    for (const listener of [...this.listeners])
      listener(kinds);
  }

  setCell(description) {
    this.cell = description;
    this.nodes = new Map(description.nodes.map((row) => [row.identity.name, row]));
    this.free = description.free ?? [];
    this.setTasks(description.tasks);
    this.touch('cell', 'nodes');
  }

  setTasks(rows) {
    this.tasks = new Map();
    this.instances = new Map();
    this.byNode = null;
    for (const row of this.nodes.values())
      this.placeInstances(row.instances);
    for (const row of rows)
      this.placeTask(row);
    this.pruneMetrics();
    this.touch('tasks', 'instances');
  }

  /** Replaces a task, and with it what is known of its instances. */
  putTask(row) {
    this.placeTask(row);
    this.pruneMetrics();
    this.touch('tasks', 'instances');
  }

  placeTask(row) {
    if (this.ended.has(row.task))
      return;
    this.forgetInstances(row.task);
    this.tasks.set(row.task, row);
    this.placeInstances(row.instances);
  }

  /** An answer may be older than the end of a task. */
  placeInstances(rows) {
    this.byNode = null;
    for (const row of rows)
      if (!this.ended.has(row.spec.task))
        this.instances.set(row.spec.instance, row);
  }

  dropTask(task) {
    this.forgetInstances(task);
    this.tasks.delete(task);
    this.pruneMetrics();
    this.touch('tasks', 'instances');
  }

  pruneMetrics() {
    for (const instance of this.metrics.keys())
      if (!this.instances.has(instance))
        this.metrics.delete(instance);
  }

  /** A task that was terminated: nothing is asked of it any more. */
  endTask(task) {
    this.ended.add(task);
    if (this.ended.size > MOST_ENDED)
      this.ended.delete(this.ended.values().next().value);
    this.dropTask(task);
  }

  forgetInstances(task) {
    this.byNode = null;
    this.instancesOf(task).forEach((x) => this.instances.delete(x.spec.instance));
  }

  instancesOf(task) {
    const known = this.tasks.get(task);
    if (known)
      return known.instances.map((x) => this.instances.get(x.spec.instance) ?? x);
    return [...this.instances.values()].filter((x) => x.spec.task === task);
  }

  /** Looked up for each row of a table, with each event. */
  instancesOn(node) {
    this.byNode ??= groupedByNode(this.instances.values());
    return this.byNode.get(node) ?? [];
  }

  setMetrics(rows) {
    for (const row of rows)
      this.metrics.set(row.spec.instance, { ...row.figures, status: row.status });
    this.touch('metrics');
  }

  addEvents(events) {
    this.events.push(...events);
    if (this.events.length > MOST_EVENTS)
      this.events.splice(0, this.events.length - MOST_EVENTS);
    this.touch('events');
  }

  setLink(state, retryAt) {
    const since = state === this.link.state ? this.link.since : Date.now();
    this.link = { state, since, retryAt };
    this.touch('link');
  }
}

function groupedByNode(instances) {
  const groups = new Map();
  for (const row of instances) {
    if (!groups.has(row.node))
      groups.set(row.node, []);
    groups.get(row.node).push(row);
  }
  return groups;
}
