// The text of a log as it grows: asked for once, and again only when the node or
// the instance was away. That the text has come to its end does not say that the
// instance has: a node between it and this page may have gone.
import { follow, Refusal } from '../cell/api.js';

const TAIL = 500;
const FIRST_PAUSE_MS = 1000;
const LONGEST_PAUSE_MS = 15000;
/** Control sequences would colour a terminal; here they would be noise. */
const CONTROL = /\u001b\[[0-9;?]*[ -/]*[@-~]|[\u0000-\u0008\u000b-\u001a\u001c-\u001f]/g;

/** A connection that has lasted so long was no failure. */
const STEADY_MS = 10000;

/**
 * hooks: onBegin() a log begins anew, onLines(lines), onState(words), and lives(),
 * whether more is to be expected of the instance.
 */
export class LogFollower {
  constructor(instance, hooks) {
    this.instance = instance;
    this.hooks = hooks;
    this.cutter = null;
    this.pause = FIRST_PAUSE_MS;
  }

  /** Lets the node go; `start` begins anew. */
  stop() {
    clearTimeout(this.timer);
    this.cutter?.abort();
    this.cutter = null;
  }

  /** Does nothing while the log is followed already. */
  start() {
    if (this.cutter)
      return;
    clearTimeout(this.timer);
    this.pause = FIRST_PAUSE_MS;
    this.followOnce();
  }

  async followOnce() {
    const cutter = new AbortController();
    this.cutter = cutter;
    this.rest = '';
    this.opened = Infinity;
    let problem = null;
    try {
      await follow(`instances/${encodeURIComponent(this.instance)}/logs?tail=${TAIL}&times=1&follow=1`, {
        signal: cutter.signal,
        onOpen: () => this.onOpen(),
        onText: (text) => this.onText(text),
      });
    } catch (caught) {
      problem = caught;
    }
    if (cutter.signal.aborted)
      return;
    this.cutter = null;
    this.onEnd(problem);
  }

  onOpen() {
    this.opened = Date.now();
    this.hooks.onBegin();
    this.hooks.onState('Following.');
  }

  onText(text) {
    const lines = (this.rest + text).split('\n');
    this.rest = lines.pop();
    this.hooks.onLines(lines.map(parted));
  }

  onEnd(problem) {
    if (problem instanceof Refusal && problem.code === 'unknown_task')
      return this.hooks.onState(problem.message);
    if (!problem && !this.hooks.lives())
      return this.hooks.onState('The log has ended.');
    if (Date.now() - this.opened > STEADY_MS)
      this.pause = FIRST_PAUSE_MS;
    const words = problem ? problem.message : 'The log has broken off';
    this.hooks.onState(`${words}. Looking again in ${this.pause / 1000} s.`);
    this.timer = setTimeout(() => this.followOnce(), this.pause);
    this.pause = Math.min(this.pause * 2, LONGEST_PAUSE_MS);
  }
}

/** Each line begins with its time, or "-" where it is not known. */
function parted(line) {
  const at = line.indexOf(' ');
  const time = Date.parse(line.slice(0, at));
  return { time: Number.isNaN(time) ? null : time, text: line.slice(at + 1).replace(CONTROL, '') };
}
