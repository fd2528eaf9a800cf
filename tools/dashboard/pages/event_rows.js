// Events as rows: when, what, whom, and the particulars in words.
import { el, keyed } from '../page/dom.js';
import { shape } from '../page/marks.js';
import { address } from '../page/router.js';
import { clock, dateAndTime, number, spoken } from '../page/words.js';

const PROBLEM = /(_lost|_failed|_refused|_died|_stuck|_stranded|_conflict|_unreachable|_out_of_reach|_trouble)$/;
const UNEASY = /(_starved|_unhealthy|_awaited|_draining|_vanished|_departing|_ignored)$/;

export function kindOfEvent({ event, data }) {
  if (PROBLEM.test(event) || data?.state === 'failed')
    return 'bad';
  if (UNEASY.test(event) || ['backing_off'].includes(data?.state))
    return 'warn';
  return 'good';
}

/** What the event is about, for filters. */
export function topicOfEvent({ event }) {
  const word = event.split('_')[0];
  if (['instance', 'skill', 'step', 'fence', 'safety', 'image', 'runtime', 'engine'].includes(word))
    return 'instances';
  if (['task', 'allocation', 'request'].includes(word))
    return 'tasks';
  return ['peer', 'cell', 'cells', 'coordinator', 'transfer', 'switch', 'join'].includes(word) ? 'cells' : 'nodes';
}

/** A coordinator tells of its own node's instances twice, once as their node; one is enough. */
export function isEcho({ event, data }, store) {
  return event === 'instance_changed' && data?.node === undefined && store.me?.role === 'coordinator';
}

export class EventRows {
  constructor(most, { dates = false } = {}) {
    this.most = most;
    this.time = dates ? dateAndTime : clock;
    this.root = el('ol', { class: 'events' });
  }

  /** The newest first. */
  update(events) {
    keyed(this.root, events.slice(0, this.most), (x) => `${x.sequence} ${x.time_unix_ms}`, (x) => this.make(x));
  }

  make(event) {
    const kind = kindOfEvent(event);
    return el('li', { class: `event ${kind}` },
      el('time', { datetime: new Date(event.time_unix_ms).toISOString() }, this.time(event.time_unix_ms)),
      el('span', { class: `state ${kind}` }, kind === 'good' ? el('span', { class: 'no-mark' }) : shape(kind), spoken(event.event)),
      subjectOf(event), el('span', { class: 'soft particulars' }, particulars(event)));
  }
}

function subjectOf({ event, subject }) {
  const page = { instance: 'instances', task: 'tasks', allocation: 'tasks', node: 'nodes' }[event.split('_')[0]];
  return page && subject ? el('a', { href: address(page, subject) }, subject) : el('span', {}, subject);
}

const UNSAID = new Set(['uuid', 'epoch', 'allocations', 'task', 'score']);

/** The data of an event as "state failed, node arm-1": words before JSON. */
export function particulars({ data = {} }) {
  return Object.entries(data).filter(([name]) => !UNSAID.has(name)).map(([name, value]) => {
    if (name === 'reason' || name === 'message')
      return String(value);
    if (name.endsWith('_unix_ms'))
      return `${spoken(name.slice(0, -8))} ${clock(value)}`;
    if (typeof value === 'object' && value !== null)
      return `${spoken(name)} ${JSON.stringify(value)}`;
    return `${spoken(name)} ${typeof value === 'number' ? number(value) : value}`;
  }).join(', ');
}

/** For a search: everything that the event says. */
export function textOfEvent(event) {
  event.searched ??= `${event.event} ${event.subject} ${JSON.stringify(event.data ?? {})}`.toLowerCase().replaceAll('_', ' ');
  return event.searched;
}
