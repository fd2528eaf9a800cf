// The events of the node, as they happen. A browser's EventSource would need the
// name of every event in advance; a newer node may tell some that are not known
// here, so the text of the stream is read by hand.
import { follow, get } from './api.js';

const FIRST_PAUSE_MS = 500;
const LONGEST_PAUSE_MS = 15000;

/** Takes the text of a stream of server-sent events apart. */
export function eventParser(onEvent) {
  let rest = '';
  return (text) => {
    const blocks = (rest + text).split('\n\n');
    rest = blocks.pop();
    for (const block of blocks) {
      const data = block.split('\n').filter((line) => line.startsWith('data:'))
        .map((line) => line.slice(5).trimStart()).join('\n');
      const event = data && parsed(data);
      if (event?.type === 'event')
        onEvent(event);
    }
  };
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

/**
 * Follows the events for as long as the page lives.
 * `onEvents(events)` gets what has come together; `onLink(state, retryAt)` hears
 * 'live' or 'away'; `onOpen(again)` is called once events flow.
 */
export class EventStream {
  constructor(hooks) {
    this.hooks = hooks;
    this.last = 0;
    this.started = 0;
    this.opened = 0;
    this.pause = FIRST_PAUSE_MS;
    this.wake = null;
    this.halted = false;
  }

  async run() {
    for (;;) {
      if (this.halted)
        await this.sleep(Infinity);
      await this.followOnce();
      if (this.halted)
        continue;
      this.hooks.onLink('away', Date.now() + this.pause);
      await this.sleep(this.pause);
      this.pause = Math.min(this.pause * 2, LONGEST_PAUSE_MS);
    }
  }

  /** Ends the present connection; the next one begins where this one stopped. */
  cut() {
    this.cutter?.abort();
  }

  halt() {
    this.halted = true;
    this.cut();
  }

  resume() {
    this.halted = false;
    this.lookNow();
  }

  lookNow() {
    this.pause = FIRST_PAUSE_MS;
    this.wake?.();
  }

  async followOnce() {
    this.cutter = new AbortController();
    const parse = eventParser((event) => this.take(event));
    this.batch = [];
    try {
      await this.checkIdentity();
      await follow(`events?since=${this.last}`, {
        signal: this.cutter.signal,
        onOpen: () => this.onOpen(),
        onText: (text) => {
          parse(text);
          this.hooks.onEvents(this.batch.splice(0));
        },
      });
    } catch {
      // Whatever it was, the remedy is the same: look again later.
    }
  }

  /** A restarted node has told anew what counts. */
  async checkIdentity() {
    const node = await get('node');
    if (node.started_unix_ms !== this.started)
      this.last = 0;
    this.started = node.started_unix_ms;
    this.hooks.onNode(node);
  }

  onOpen() {
    this.pause = FIRST_PAUSE_MS;
    this.hooks.onLink('live');
    this.hooks.onOpen(this.opened++ > 0);
  }

  take(event) {
    this.last = Math.max(this.last, event.sequence);
    this.batch.push(event);
  }

  sleep(milliseconds) {
    return new Promise((resolve) => {
      this.wake = resolve;
      if (milliseconds !== Infinity)
        setTimeout(resolve, milliseconds);
    });
  }
}
