// Keys for who does not want to leave the keyboard. They do nothing while
// somebody writes.
import { el } from './dom.js';

const GO_MS = 1200;

export class Shortcuts {
  constructor() {
    this.keys = [];
    this.going = 0;
    document.addEventListener('keydown', (event) => this.onKey(event));
  }

  /** `keys` is one key, or 'g' and another. */
  add(keys, meaning, action) {
    this.keys.push({ keys, meaning, action });
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || isWriting(event.target))
      return;
    const second = Date.now() - this.going < GO_MS;
    const pressed = second ? `g ${event.key}` : event.key;
    this.going = event.key === 'g' && !second ? Date.now() : 0;
    const found = this.keys.find((x) => x.keys === pressed);
    if (!found)
      return;
    event.preventDefault();
    found.action();
  }

  list() {
    return el('dl', { class: 'keys' }, this.keys.map(({ keys, meaning }) =>
      el('div', {}, el('dt', {}, keys.split(' ').map((x) => el('kbd', {}, x))), el('dd', {}, meaning))));
  }
}

function isWriting(element) {
  return element.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(element.tagName);
}
