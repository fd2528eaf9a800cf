// Elements are made by these functions only. What comes from the network is
// always text, never markup, so that a name or a log line cannot become a page.

const SVG = 'http://www.w3.org/2000/svg';

/** el('button', {class: 'quiet', on: {click}}, 'text', child...) */
export function el(tag, properties = {}, ...children) {
  return filled(document.createElement(tag), properties, children);
}

export function button(words, act, more = {}) {
  return el('button', { type: 'button', ...more, on: { click: act } }, words);
}

export function svg(tag, properties = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), properties, children);
}

function filled(element, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (name === 'on')
      Object.entries(value).forEach(([event, listener]) => element.addEventListener(event, listener));
    else
      setAttribute(element, name, value);
  }
  element.append(...children.flat().filter((x) => x !== null && x !== undefined && x !== false));
  return element;
}

/** Sets what has changed only: a browser lays out again what it is given again. */
export function setAttribute(element, name, value) {
  const absent = value === null || value === undefined || value === false;
  if (absent)
    element.removeAttribute(name);
  else if (element.getAttribute(name) !== String(value))
    element.setAttribute(name, value === true ? '' : value);
}

export function setText(element, text) {
  const words = text === null || text === undefined ? '' : String(text);
  if (element.shownText === words)
    return;
  element.shownText = words;
  element.textContent = words;
}

export function replace(parent, ...children) {
  parent.replaceChildren(...children.flat().filter((x) => x !== null && x !== undefined && x !== false));
}

/** Makes the children of `parent` again only when what they are made of, `parts`, has changed. */
export function remade(parent, parts, make) {
  const words = JSON.stringify(parts);
  if (parent.madeOf === words)
    return;
  parent.madeOf = words;
  replace(parent, make());
}

/**
 * Makes the children of `parent` those of `items`, in this order, and keeps the
 * elements of items that stay: focus, selection and scrolling survive.
 */
export function keyed(parent, items, keyOf, make, update) {
  const known = parent.keyedChildren ?? new Map();
  const next = new Map();
  const focused = parent.contains(document.activeElement) ? document.activeElement : null;
  // First, or everything behind one that goes would be moved.
  const wanted = new Set(items.map(keyOf));
  for (const [key, element] of known)
    if (!wanted.has(key))
      element.remove();
  let cursor = parent.firstChild;
  for (const item of items) {
    const key = keyOf(item);
    const element = known.get(key) ?? make(item);
    update?.(element, item);
    next.set(key, element);
    if (element === cursor)
      cursor = cursor.nextSibling;
    else
      parent.insertBefore(element, cursor);
  }
  parent.keyedChildren = next;
  // An element that is moved loses the focus.
  if (focused && focused !== document.activeElement && parent.contains(focused))
    focused.focus({ preventScroll: true });
}

/** Attributes in two columns: `attributes([['Address', element or text], ...])`. */
export function attributes(rows) {
  return el('dl', { class: 'attributes' }, rows.filter(([, value]) => value !== null && value !== undefined && value !== '' && value.length !== 0)
    .map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {}, value))));
}

let ids = 0;

/** An id that no other element of the page has, for labels. */
export function freshId(word) {
  return `${word}-${++ids}`;
}
