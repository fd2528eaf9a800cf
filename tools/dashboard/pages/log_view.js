// The lines of a log, bounded, with a filter. It stays at the end while somebody
// reads the end, and stands still while they read elsewhere.
import { button, el, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { clock } from '../page/words.js';
import { LogFollower } from './log_follower.js';
import { SearchField } from './search_field.js';

const MOST_LINES = 3000;

export class LogView {
  /** `lives()` tells whether more is to be expected of the instance. */
  constructor(instance, lives) {
    this.lines = [];
    this.fresh = [];
    this.anew = false;
    this.atEnd = true;
    this.find = new SearchField('words of a line', () => this.redraw());
    this.state = el('span', { class: 'soft', role: 'status' });
    this.newest = button('To the newest line', () => this.toEnd(), { class: 'quiet' });
    this.box = el('div', { class: 'log', tabindex: 0, role: 'log', 'aria-live': 'off', 'aria-label': 'Log', on: { scroll: () => this.onScroll() } });
    this.root = el('div', {},
      el('p', { class: 'filters' }, this.find.parts, this.state, this.newest), this.box);
    this.draw = onceAFrame(() => this.drawFresh());
    this.follower = new LogFollower(instance, {
      lives,
      onBegin: () => { this.anew = true; },
      onLines: (lines) => this.add(lines),
      onState: (words) => setText(this.state, words),
    });
    this.onScroll();
    this.follower.start();
  }

  /** Lets the node go. */
  stop() {
    this.follower.stop();
  }

  /** The instance runs again, or the node is back: the log goes on. */
  again() {
    this.follower.start();
  }

  add(lines) {
    // What is shown stays until there is something to show in its place.
    if (this.anew && lines.length > 0)
      this.beginAnew();
    for (const list of [this.lines, this.fresh]) {
      list.push(...lines);
      list.splice(0, list.length - MOST_LINES);
    }
    this.draw();
  }

  beginAnew() {
    this.anew = false;
    this.lines = [];
    this.fresh = [];
    this.emptied = true;
  }

  redraw() {
    this.fresh = [...this.lines];
    this.emptied = true;
    this.drawFresh();
  }

  drawFresh() {
    const { scrollTop } = this.box;
    if (this.emptied)
      this.box.replaceChildren();
    this.emptied = false;
    const lines = this.fresh.splice(0).filter((x) => x.text.toLowerCase().includes(this.find.words)).slice(-MOST_LINES);
    this.box.append(...lines.map(makeLine));
    while (this.box.childElementCount > MOST_LINES)
      this.box.firstElementChild.remove();
    this.box.scrollTop = this.atEnd ? this.box.scrollHeight : scrollTop;
  }

  onScroll() {
    this.atEnd = this.box.scrollHeight - this.box.scrollTop - this.box.clientHeight < 30;
    this.newest.hidden = this.atEnd;
  }

  toEnd() {
    this.box.scrollTop = this.box.scrollHeight;
    this.box.focus();
  }
}

function makeLine({ time, text }) {
  return el('div', { class: 'line' }, el('time', {}, time === null ? '–' : clock(time, true)), el('span', {}, text));
}
