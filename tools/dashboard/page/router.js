// Which room is open stands behind the # of the address: it can be kept, sent to
// somebody, and gone back from.
import { el } from './dom.js';

/** '#/tasks/fetch?step=a' is {page: 'tasks', name: 'fetch', query}. */
export function place(hash = location.hash) {
  const [path, query = ''] = hash.replace(/^#\/?/, '').split('?');
  const [page = '', ...rest] = path.split('/');
  return { page: page || 'site', name: safelyDecoded(rest.join('/')), query: new URLSearchParams(query) };
}

function safelyDecoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

export function address(page, name = '', query = {}) {
  const words = new URLSearchParams(query).toString();
  return `#/${page}${name ? `/${encodeURIComponent(name)}` : ''}${words ? `?${words}` : ''}`;
}

/** A link that looks like a button. */
export function way(words, ...where) {
  return el('a', { class: 'button', href: address(...where) }, words);
}
