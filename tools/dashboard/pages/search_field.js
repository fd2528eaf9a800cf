// The field in which somebody writes what they look for.
import { el, freshId } from '../page/dom.js';
import { onceAFrame } from '../page/frames.js';

export class SearchField {
  constructor(placeholder, onInput, value = '') {
    const id = freshId('find');
    this.input = el('input', { type: 'search', id, placeholder, value: value ?? '', on: { input: onceAFrame(onInput) } });
    this.parts = [el('label', { for: id }, 'Find'), this.input];
  }

  get words() {
    return this.input.value.toLowerCase();
  }

  /** Whether each of the words stands in a text of small letters. */
  fits(text, words = this.words) {
    return words.split(/\s+/).every((word) => text.includes(word));
  }
}
