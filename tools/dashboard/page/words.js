// How things are said: numbers with few digits, times as people say them, and
// of each state a kind, which gives its colour and its shape.

const KINDS = {
  good: ['active', 'running', 'member', 'joined', 'already_member', 'live', 'good', 'safe', 'coordinator'],
  done: ['finished', 'done', 'drained'],
  busy: ['pending', 'building', 'starting', 'deploying', 'reserved', 'departing', 'preparing', 'switching',
    'joining', 'stopping', 'terminating', 'expected', 'connecting'],
  warn: ['degraded', 'backing_off', 'draining', 'starved', 'unhealthy', 'unresolved', 'returned', 'problem',
    'orphaned', 'unsafe'],
  bad: ['failed', 'lost', 'away', 'refused'],
  off: ['stopped', 'independent', 'paused'],
};
const KIND_OF = new Map(Object.entries(KINDS).flatMap(([kind, states]) => states.map((x) => [x, kind])));

export function kindOf(state) {
  return KIND_OF.get(state) ?? 'unknown';
}

/** What an instance is, in one word: its node may be away, its streams may be broken. */
export function instanceState(row) {
  if (row.unknown_since_unix_ms)
    return 'unknown';
  if (row.state === 'running' && row.health && row.health !== 'good')
    return row.health;
  return row.state;
}

export function nodeState(row) {
  return row.state === 'active' && row.draining_since_unix_ms ? 'draining' : row.state;
}

export function spoken(word) {
  return String(word ?? '').replaceAll('_', ' ');
}

export function number(value, digits = 3) {
  if (value === null || value === undefined)
    return '';
  if (value === 0 || Number.isInteger(value) && Math.abs(value) < 1e6)
    return String(value);
  return Number(value.toPrecision(digits)).toLocaleString('en', { maximumFractionDigits: 6, useGrouping: false });
}

export function mebibytes(value) {
  if (value === undefined)
    return '';
  return value >= 10240 ? `${number(value / 1024)} GiB` : `${number(value)} MiB`;
}

export function hertz(value) {
  return value === undefined || value === null ? '' : `${value.toFixed(value < 10 ? 1 : 0)} Hz`;
}

export function milliseconds(value) {
  if (value === undefined || value === null)
    return '';
  return value >= 10000 ? `${(value / 1000).toFixed(0)} s` : `${number(value, value < 1 ? 1 : 2)} ms`;
}

export function ofMebibytes(amount) {
  return amount.capacity >= 10240 ? `${mebibytes(amount.used)} of ${mebibytes(amount.capacity)}`
    : `${number(amount.used)} of ${number(amount.capacity)} MiB`;
}

export function labelWords(labels = {}) {
  return Object.entries(labels).map(([name, value]) => `${name}=${value}`).join('  ');
}

export function percent(share) {
  return `${Math.round(share * 100)} %`;
}

/** How long ago, in the largest unit that fits: 12 s, 5 min, 3 h, 2 d. */
export function ago(unix_ms, now = Date.now()) {
  const seconds = Math.max(0, Math.round((now - unix_ms) / 1000));
  if (seconds < 90)
    return `${seconds} s`;
  if (seconds < 90 * 60)
    return `${Math.round(seconds / 60)} min`;
  return seconds < 48 * 3600 ? `${Math.round(seconds / 3600)} h` : `${Math.round(seconds / 86400)} d`;
}

const pad = (value, width = 2) => String(value).padStart(width, '0');

export function clock(unix_ms, withMilliseconds = false) {
  const time = new Date(unix_ms);
  const text = `${pad(time.getHours())}:${pad(time.getMinutes())}:${pad(time.getSeconds())}`;
  return withMilliseconds ? `${text}.${pad(time.getMilliseconds(), 3)}` : text;
}

export function dateAndTime(unix_ms) {
  const time = new Date(unix_ms);
  return `${time.getFullYear()}-${pad(time.getMonth() + 1)}-${pad(time.getDate())} ${clock(unix_ms)}`;
}

export function count(amount, word) {
  return `${amount} ${word}${amount === 1 ? '' : 's'}`;
}

/** A list where the messages allow one thing or several. */
export function asList(value) {
  if (value === undefined || value === null)
    return [];
  return Array.isArray(value) ? value : [value];
}
