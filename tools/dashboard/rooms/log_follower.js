// The text of a log as it grows: asked for once, and again only when the node or
// the instance was away.
import { follow, Refusal } from '../cell/api.js';

const TAIL = 500;
const FIRST_PAUSE_MS = 1000;
const LONGEST_PAUSE_MS = 15000;
/** Control sequences would colour a terminal; here they would be noise. */
const CONTROL = /\u001b\[[0-9;?]*[ -/]*[@-~]|[\u0000-\u0008\u000b-\u001a\u001c-\u001f]/g;

/** hooks: onBegin() a log begins anew, onLines(lines), onState(words). */
export class LogFollower {
  constructor(instance, hooks) {
    this.instance = instance;
    this.hooks = hooks;
    this.cutter = new AbortController();
    this.pause = FIRST_PAUSE_MS;
    this.following = false;
  }

  close() {
    this.cutter.abort();
    clearTimeout(this.timer);
  }

  /** Does nothing while the log is followed already. */
  async start() {
    if (this.following)
      return;
    this.following = true;
    clearTimeout(this.timer);
    this.rest = '';
    try {
      await follow(`instances/${encodeURIComponent(this.instance)}/logs?tail=${TAIL}&times=1&follow=1`, {
        signal: this.cutter.signal,
        onOpen: () => this.onOpen(),
        onText: (text) => this.onText(text),
      });
      this.hooks.onState('The log has ended.');
    } catch (trouble) {
      this.onTrouble(trouble);
    }
    this.following = false;
  }

  onOpen() {
    this.pause = FIRST_PAUSE_MS;
    this.hooks.onBegin();
    this.hooks.onState('Following.');
  }

  onText(text) {
    const lines = (this.rest + text).split('\n');
    this.rest = lines.pop();
    this.hooks.onLines(lines.map(parted));
  }

  onTrouble(trouble) {
    if (this.cutter.signal.aborted)
      return;
    this.hooks.onState(trouble.message);
    if (trouble instanceof Refusal && trouble.code === 'unknown_task')
      return;
    this.timer = setTimeout(() => this.start(), this.pause);
    this.pause = Math.min(this.pause * 2, LONGEST_PAUSE_MS);
  }
}

/** Each line begins with its time, or "-" where it is not known. */
function parted(line) {
  const at = line.indexOf(' ');
  const time = Date.parse(line.slice(0, at));
  return { time: Number.isNaN(time) ? null : time, text: line.slice(at + 1).replace(CONTROL, '') };
}
