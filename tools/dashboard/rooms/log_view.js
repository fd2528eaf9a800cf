// The lines of a log, bounded, with a filter. It stays at the end while somebody
// reads the end, and stands still while they read elsewhere.
import { el, freshId, setText } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';
import { clock } from '../page/words.js';
import { LogFollower } from './log_follower.js';

const MOST_LINES = 3000;

export class LogView {
  constructor(instance) {
    this.lines = [];
    this.fresh = [];
    this.atEnd = true;
    const find = freshId('find');
    this.find = el('input', { type: 'search', id: find, placeholder: 'words of a line', on: { input: onceAFrame(() => this.redraw()) } });
    this.state = el('span', { class: 'soft', role: 'status' });
    this.newest = el('button', { type: 'button', class: 'quiet', on: { click: () => this.toEnd() } }, 'To the newest line');
    this.box = el('div', { class: 'log', tabindex: 0, role: 'log', 'aria-live': 'off', 'aria-label': 'Log', on: { scroll: () => this.onScroll() } });
    this.root = el('div', {},
      el('p', { class: 'filters' }, el('label', { for: find }, 'Find'), this.find, this.state, this.newest), this.box);
    this.draw = onceAFrame(() => this.drawFresh());
    this.follower = new LogFollower(instance, {
      onBegin: () => { this.lines = []; this.redraw(); },
      onLines: (lines) => this.add(lines),
      onState: (words) => setText(this.state, words),
    });
    this.onScroll();
    this.follower.start();
  }

  close() {
    this.follower.close();
  }

  /** The instance runs again: its log goes on. */
  again() {
    this.follower.start();
  }

  add(lines) {
    this.lines.push(...lines);
    this.fresh.push(...lines);
    if (this.lines.length > MOST_LINES)
      this.lines.splice(0, this.lines.length - MOST_LINES);
    this.draw();
  }

  wanted(line) {
    const words = this.find.value.toLowerCase();
    return !words || line.text.toLowerCase().includes(words);
  }

  redraw() {
    this.fresh = [...this.lines];
    this.box.replaceChildren();
    this.drawFresh();
  }

  drawFresh() {
    const lines = this.fresh.splice(0).filter((x) => this.wanted(x)).slice(-MOST_LINES);
    this.box.append(...lines.map(makeLine));
    while (this.box.childElementCount > MOST_LINES)
      this.box.firstElementChild.remove();
    if (this.atEnd)
      this.box.scrollTop = this.box.scrollHeight;
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
