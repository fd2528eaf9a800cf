// Figures that no event tells: what is used of the nodes, rates, latencies. They
// are asked for only while somebody can see them, every 5 s at most, and more
// seldom where the answer takes long, so that the node spends less than a
// hundredth of its time on this page.
import { get, NoAnswer, Refusal, send } from './api.js';
import { Samples } from './samples.js';

const EVERY_MS = 5000;
const LONGEST_MS = 30000;
const SHARE = 100;

export class Figures {
  /** `again` is told what is to be asked because it has changed while figures came. */
  constructor(store, onTrouble, again) {
    this.store = store;
    this.onTrouble = onTrouble;
    this.again = again;
    this.samples = new Samples();
    this.wishes = [];
    this.timer = null;
    document.addEventListener('visibilitychange', () => this.lookSoon());
  }

  /** The room that is open says what it shows: 'resources', 'instances', or instances as a query names them. */
  wish(...wishes) {
    this.wishes = wishes.filter(Boolean);
    this.lookSoon();
  }

  lookSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.look(), 50);
  }

  async look() {
    const begun = Date.now();
    if (!document.hidden && this.wishes.length > 0 && this.store.link.state === 'live') {
      try {
        await Promise.all(this.wishes.map((wish) => this.answer(wish)));
      } catch (trouble) {
        if (trouble instanceof NoAnswer)
          this.onTrouble(trouble);
      }
    }
    const pause = Math.min(LONGEST_MS, Math.max(EVERY_MS, SHARE * (Date.now() - begun)));
    clearTimeout(this.timer);
    if (!document.hidden)
      this.timer = setTimeout(() => this.look(), pause);
  }

  answer(wish) {
    if (wish === 'resources')
      return this.store.flights.during(() => this.readResources(), this.again);
    return wish === 'instances' ? this.readInstances(get('instances')) : this.readSome(wish);
  }

  async readInstances(answer) {
    this.store.setFigures((await answer).instances);
  }

  /** What is refused is not there any more; each refusal is an event, for everybody. */
  async readSome(wish) {
    try {
      await this.readInstances(send(JSON.stringify({ type: 'instance_query', ...wish })));
    } catch (trouble) {
      if (!(trouble instanceof Refusal))
        throw trouble;
      this.wishes = this.wishes.filter((x) => x !== wish);
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
    this.store.touch('figures', 'nodes');
  }
}
