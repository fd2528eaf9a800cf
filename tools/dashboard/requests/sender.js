// A JSON document on its way to the node, and what came back. The document that
// is sent is the one that is shown.
import { send } from '../cell/api.js';
import { JsonBox } from '../json/json_box.js';
import { el, replace, setText } from '../page/dom.js';
import { shape } from '../page/marks.js';
import { spoken } from '../page/words.js';
import { refusalView } from './refusal_view.js';

export class Sender {
  constructor({ label, action, grave = false, onDocument, onReply }) {
    this.action = action;
    this.onReply = onReply;
    this.fields = null;
    this.box = new JsonBox({ label, onDocument });
    this.button = el('button', { type: 'button', class: grave ? 'main grave' : 'main', on: { click: () => this.send() } }, action);
    this.cancel = el('button', { type: 'button', hidden: true, on: { click: () => this.cutter.abort() } }, 'Wait no longer');
    this.state = el('span', { class: 'soft', role: 'status' });
    this.reply = el('div', { class: 'reply' });
    this.buttons = el('p', { class: 'actions' }, this.button, this.cancel, this.state);
    this.root = el('div', { class: 'sender' }, this.box.root, this.buttons);
  }

  async send(text = this.box.text) {
    this.cutter = new AbortController();
    this.busy(true);
    replace(this.reply);
    try {
      const reply = await send(text, this.cutter.signal);
      replace(this.reply, this.onReply?.(reply) ?? replyView(reply));
    } catch (trouble) {
      replace(this.reply, trouble.name === 'AbortError' ? el('p', {}, 'The node goes on with it; its events tell how it ends.')
        : refusalView(trouble, this.box, this.fields));
    }
    this.busy(false);
    this.reply.scrollIntoView({ block: 'nearest' });
  }

  busy(whether) {
    this.button.disabled = whether;
    this.cancel.hidden = !whether;
    setText(this.state, whether ? 'The node works on it …' : '');
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
    return `${reply.waiting.length} instances are waited for until they are safe`;
  if (reply.type === 'node_drained')
    return reply.left.length ? `${reply.left.length} instances are still there. ${reply.trouble ?? ''}` : 'it is empty';
  if (reply.type === 'cell_rebalanced')
    return reply.moves.map((x) => `${x.task} / ${x.step} from ${x.from} to ${x.to}: ${spoken(x.state ?? 'planned')}`).join(', ') || 'no move is worth it';
  if (reply.type === 'cell_formed')
    return reply.outcomes.map((x) => `${x.node}: ${spoken(x.result)}${x.message ? ` (${x.message})` : ''}`).join(', ');
  return '';
}
