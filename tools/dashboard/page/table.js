// A table that can be sorted and paged. Rows keep their elements while they are
// shown, so an update costs what has changed, and a page is at most 50 rows,
// however many there are.
import { button, el, keyed, setAttribute, setText } from './dom.js';

const PAGE = 50;

/**
 * columns: {title, make(cell), update(cell, item), order(item), class}
 * Either `make` and `update`, or `text(item)`. `href(item)` makes the first cell a link.
 */
export class Table {
  constructor({ caption, columns, keyOf, href, empty, sort = 0, backwards = false, page = PAGE }) {
    Object.assign(this, { columns, keyOf, href, empty, sort, backwards, size: page });
    this.page = 0;
    this.items = [];
    this.heads = columns.map((column, index) => this.makeHead(column, index));
    this.body = el('tbody', { on: { keydown: (event) => this.onKey(event) } });
    this.none = el('p', { class: 'empty' });
    this.pager = new Pager((step) => this.turn(step));
    this.root = el('div', { class: 'table-box' },
      el('div', { class: 'scroll-x' },
        el('table', {}, el('caption', { class: 'sr' }, caption), el('thead', {}, el('tr', {}, this.heads)), this.body)),
      this.none, this.pager.root);
  }

  update(items) {
    this.items = items;
    this.draw();
  }

  makeHead(column, index) {
    if (!column.order)
      return el('th', { scope: 'col', class: column.class }, column.title);
    return el('th', { scope: 'col', class: column.class },
      button(column.title, () => this.sortBy(index), { class: 'head' }));
  }

  sortBy(index) {
    this.backwards = this.sort === index ? !this.backwards : false;
    this.sort = index;
    this.page = 0;
    this.draw();
  }

  turn(step) {
    this.page += step;
    this.draw();
  }

  sorted() {
    const order = this.columns[this.sort]?.order;
    if (!order)
      return this.items;
    const way = this.backwards ? -1 : 1;
    return this.items.map((item) => [order(item), item]).sort(([a], [b]) => way * compare(a, b)).map(([, item]) => item);
  }

  draw() {
    const last = Math.max(0, Math.ceil(this.items.length / this.size) - 1);
    this.page = Math.min(Math.max(0, this.page), last);
    const from = this.page * this.size;
    const shown = this.sorted().slice(from, from + this.size);
    keyed(this.body, shown, this.keyOf, () => this.makeRow(), (row, item) => this.updateRow(row, item));
    this.heads.forEach((head, index) => setAttribute(head, 'aria-sort',
      this.columns[index].order && index === this.sort ? (this.backwards ? 'descending' : 'ascending') : null));
    setText(this.none, this.items.length === 0 ? this.empty : '');
    this.pager.update(from, shown.length, this.items.length);
  }

  makeRow() {
    const row = el('tr', {});
    row.parts = this.columns.map((column, index) => {
      const tag = index === 0 ? 'th' : 'td';
      const cell = el(tag, { class: column.class, scope: index === 0 ? 'row' : null });
      const inner = index === 0 && this.href ? cell.appendChild(el('a', { class: 'row-link' })) : cell;
      inner.parts = column.make?.(inner);
      row.append(cell);
      return inner;
    });
    return row;
  }

  updateRow(row, item) {
    if (this.href)
      setAttribute(row.parts[0], 'href', this.href(item));
    this.columns.forEach((column, index) => {
      const cell = row.parts[index];
      if (column.update)
        column.update(cell, item, cell.parts);
      else
        setText(cell, column.text(item));
    });
  }

  /** The arrow keys go from row to row. */
  onKey(event) {
    const way = { ArrowDown: 'nextElementSibling', ArrowUp: 'previousElementSibling' }[event.key];
    const link = event.target.closest('a.row-link');
    if (!way || !link)
      return;
    event.preventDefault();
    link.closest('tr')[way]?.querySelector('a.row-link')?.focus();
  }
}

// Made once: to make one for each comparison takes longer than to draw the table.
const WORDS = new Intl.Collator('en', { numeric: true });

function compare(a, b) {
  if (typeof a === 'number' && typeof b === 'number')
    return a - b;
  return WORDS.compare(String(a ?? ''), String(b ?? ''));
}

/** "51 to 100 of 500", and the way to the others. */
export class Pager {
  constructor(turn) {
    this.words = el('span', {});
    this.back = button('Previous', () => turn(-1), { class: 'quiet' });
    this.on = button('Next', () => turn(1), { class: 'quiet' });
    this.root = el('nav', { class: 'pager', 'aria-label': 'Pages' }, this.back, this.words, this.on);
  }

  update(from, shown, all) {
    this.root.hidden = shown === all;
    setText(this.words, `${from + 1} to ${from + shown} of ${all}`);
    this.back.disabled = from === 0;
    this.on.disabled = from + shown >= all;
  }
}
