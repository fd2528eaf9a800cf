// Metrics that no event tells: what is used of the nodes, rates, latencies. They
// are asked for only while somebody can see them, every 5 s at most, and more
// seldom where the answer takes long, so that the node spends less than a
// hundredth of its time on this page.
import { get, NoAnswer, Refusal, send } from './api.js';
import { Samples } from './samples.js';

const EVERY_MS = 5000;
const LONGEST_MS = 30000;
const SHARE = 100;

export class Metrics {
  /** `again` is told what is to be asked because it has changed while metrics came. */
  constructor(store, onProblem, again) {
    this.store = store;
    this.onProblem = onProblem;
    this.again = again;
    this.samples = new Samples();
    this.requests = [];
    this.timer = null;
    document.addEventListener('visibilitychange', () => this.lookSoon());
  }

  /** The page that is open says what it shows: 'resources', 'instances', or instances as a query names them. */
  request(...requests) {
    this.requests = requests.filter(Boolean);
    this.lookSoon();
  }

  lookSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.look(), 50);
  }

  async look() {
    const begun = Date.now();
    if (!document.hidden && this.requests.length > 0 && this.store.link.state === 'live') {
      try {
        await Promise.all(this.requests.map((request) => this.answer(request)));
      } catch (problem) {
        if (problem instanceof NoAnswer)
          this.onProblem(problem);
      }
    }
    const pause = Math.min(LONGEST_MS, Math.max(EVERY_MS, SHARE * (Date.now() - begun)));
    clearTimeout(this.timer);
    if (!document.hidden)
      this.timer = setTimeout(() => this.look(), pause);
  }

  answer(request) {
    if (request === 'resources')
      return this.store.flights.during(() => this.readResources(), this.again);
    return request === 'instances' ? this.readInstances(get('instances')) : this.readSome(request);
  }

  async readInstances(answer) {
    this.store.setMetrics((await answer).instances);
  }

  /** What is refused is not there any more; each refusal is an event, for everybody. */
  async readSome(request) {
    try {
      await this.readInstances(send(JSON.stringify({ type: 'instance_query', ...request })));
    } catch (problem) {
      if (!(problem instanceof Refusal))
        throw problem;
      this.requests = this.requests.filter((x) => x !== request);
    }
  }

  async readResources() {
    const [cell, me] = await Promise.all([get('cell?resources=now'), get('node')]);
    this.store.me = me;
    this.store.setCell(cell);
    for (const row of this.store.nodes.values()) {
      // The node that answers measures itself at once.
      if (row.identity.name === me.identity.name)
        row.resources = me.resources;
      if (row.state === 'active')
        this.samples.add(row.identity.name, row.resources);
    }
    this.samples.prune([...this.store.nodes.keys()]);
    this.store.touch('metrics', 'nodes');
  }
}
