// A JSON document on its way to the node, and what came back. The document that
// is sent is the one that is shown, with a request id, so that it can be sent again
// without being done again.
import { send } from '../cell/api.js';
import { JsonBox } from '../json/json_box.js';
import { button, el, replace, setText } from '../page/dom.js';
import { shape } from '../page/marks.js';
import { spoken } from '../page/words.js';
import { isOpenEnd, openEnd, refusalView } from './refusal_view.js';

export class Sender {
  constructor({ label, action, grave = false, onDocument, onReply }) {
    this.action = action;
    this.onReply = onReply;
    this.fields = null;
    this.box = new JsonBox({ label, onDocument });
    this.button = button(action, () => this.send(), { class: grave ? 'main grave' : 'main' });
    this.cancel = button('Wait no longer', () => this.cutter.abort(), { hidden: true });
    this.state = el('span', { class: 'soft', role: 'status' });
    this.reply = el('div', { class: 'reply' });
    this.buttons = el('p', { class: 'actions' }, this.button, this.cancel, this.state);
    this.root = el('div', { class: 'sender' }, this.box.root, this.buttons);
  }

  async send(text = withId(this.box.text)) {
    this.cutter = new AbortController();
    this.busy(true);
    replace(this.reply);
    try {
      const reply = await send(text, this.cutter.signal);
      replace(this.reply, this.onReply?.(reply) ?? replyView(reply));
    } catch (problem) {
      replace(this.reply, this.problemView(problem, text));
    }
    this.busy(false);
    this.reply.scrollIntoView({ block: 'nearest' });
  }

  problemView(problem, text) {
    if (problem.name === 'AbortError')
      return el('p', {}, 'The node goes on with it; its events tell how it ends.');
    return isOpenEnd(problem) ? openEnd(problem, objectIn(text) ?? {}, () => this.send(text)) : refusalView(problem, this.box, this.fields);
  }

  busy(whether) {
    this.button.disabled = whether;
    this.cancel.hidden = !whether;
    setText(this.state, whether ? 'The node works on it …' : '');
  }
}

/** What is no request is sent as it is, and refused with its place. */
function withId(text) {
  const document = objectIn(text);
  const id = crypto.getRandomValues(new Uint32Array(3)).join('-');
  return document ? JSON.stringify({ request_id: `dashboard-${id}`, ...document }) : text;
}

/** The object that a text is, or null. */
export function objectIn(text) {
  try {
    const document = JSON.parse(text);
    return typeof document === 'object' && !Array.isArray(document) ? document : null;
  } catch {
    return null;
  }
}

/** Any reply: its kind in words, and all of it. */
export function replyView(reply) {
  const box = new JsonBox({ label: 'The reply', readOnly: true });
  box.set(reply);
  return el('div', {}, el('p', { class: 'state good', role: 'status' }, shape('good'),
    el('span', {}, el('b', {}, `Done: ${spoken(reply.type)}. `), summary(reply))), box.root);
}

function summary(reply) {
  if (reply.type === 'task_terminated' && reply.waiting?.length)
    return `${reply.waiting.length} instances are waited for until they are stop-safe`;
  if (reply.type === 'node_drained')
    return reply.left.length ? `${reply.left.length} instances are still there. ${reply.trouble ?? ''}` : 'it is empty';
  if (reply.type === 'cell_rebalanced')
    return reply.moves.map((x) => `${x.task} / ${x.step} from ${x.from} to ${x.to}: ${spoken(x.state ?? 'planned')}`).join(', ') || 'no move is worth it';
  if (reply.type === 'cell_formed')
    return reply.outcomes.map((x) => `${x.node}: ${spoken(x.result)}${x.message ? ` (${x.message})` : ''}`).join(', ');
  return '';
}
