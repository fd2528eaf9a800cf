// Which room is open stands behind the # of the address: it can be kept, sent to
// somebody, and gone back from.
import { el } from './dom.js';

/** '#/tasks/fetch?step=a' is {room: 'tasks', name: 'fetch', query}. */
export function place(hash = location.hash) {
  const [path, query = ''] = hash.replace(/^#\/?/, '').split('?');
  const [room = '', ...rest] = path.split('/');
  return { room: room || 'site', name: safelyDecoded(rest.join('/')), query: new URLSearchParams(query) };
}

function safelyDecoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

export function address(room, name = '', query = {}) {
  const words = new URLSearchParams(query).toString();
  return `#/${room}${name ? `/${encodeURIComponent(name)}` : ''}${words ? `?${words}` : ''}`;
}

/** A link that looks like a button. */
export function way(words, ...where) {
  return el('a', { class: 'button', href: address(...where) }, words);
}
