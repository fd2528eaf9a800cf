// The columns of tables, as the program describes them for its own tables
// (described.js): here is how the page says what stands in one, and draws it.
import { shares } from '../cell/samples.js';
import { COLUMNS } from '../described.js';
import { el, setAttribute } from '../page/dom.js';
import { meter, sparkline, stateMark, updateMeter, updateSparkline, updateState } from '../page/marks.js';
import {
  ago, hertz, instanceState, labelWords, mebibytes, milliseconds, nodeState, number, ofMebibytes, spoken,
} from '../page/words.js';

/** By the column's word: what is shown of its value. */
const WORDS = {
  count: (x) => number(x, 9), number: (x) => number(x), hertz, milliseconds, mebibytes, since: (x) => ago(x),
  labels: labelWords, gpus: gpuWords, programs, problems: (x = []) => x.join('; '),
  skill: (x, { spec }) => `${x} / ${spec.model} / ${spec.deployment}`,
  amount: (_, row, app) => app.store.instancesOn(row.identity.name).length,
  running: (_, row, app) => runningWords(app.store.instancesOf(row.task)),
  nodes: (_, row, app) => [...new Set(app.store.instancesOf(row.task).map((x) => x.node))].join(', '),
};

const STATES = { state: (x) => x.state, node_state: nodeState, instance_state: instanceState };

const ORDERS = {
  // Rows that are alike would change their places with each answer.
  key: (x, { spec }) => (spec ? `${spec.task} ${spec.step}` : x),
  since: (x) => -x, usage: (x) => x.used / x.capacity,
  running: (_, row, app) => notRunning(app.store.instancesOf(row.task)).length,
};

/** Those of a kind of things, without one that a page says elsewhere; the one that leads on is the first. */
export function columnsOf(kind, app, without = '') {
  return COLUMNS[kind].filter((x) => x.name !== without).map((x) => made(x, app)).sort((a, b) => b.leads - a.leads);
}

function made({ name, as, path, number: isNumber, minor }, app) {
  const members = path.split('/').slice(1);
  const value = members[0] === 'figures' ? (row) => at(figuresOf(row, app), members.slice(1)) : (row) => at(row, members);
  const text = (row) => (WORDS[as] ?? String)(value(row) ?? (as in WORDS ? undefined : ''), row, app);
  const plain = (row) => (typeof value(row) === 'object' || !path ? text(row) : value(row) ?? (isNumber ? -1 : ''));
  const column = {
    title: titleOf(name), leads: as === 'key', text, order: (row) => ORDERS[as]?.(value(row), row, app) ?? plain(row),
    class: [isNumber && as !== 'usage' && 'number', minor && 'minor', as === 'labels' && as, as === 'problems' && 'wrong'].filter(Boolean).join(' ') || null,
  };
  if (as === 'usage')
    return { ...column, ...usage(members.at(-1), app) };
  return STATES[as] ? { ...column, ...state(STATES[as], app) } : column;
}

const at = (row, members) => members.reduce((x, member) => x?.[member], row);

/** What is known of an instance's metrics now. */
function figuresOf({ spec, figures }, { store }) {
  return store.metrics.get(spec.instance) ?? figures;
}

/** "DATA AGE" is "Data age"; short ones are abbreviations. */
function titleOf(name) {
  return name.split(' ').map((x, i) => (x.length < 4 ? x : (i ? '' : x[0]) + x.slice(i ? 0 : 1).toLowerCase())).join(' ');
}

function state(of, app) {
  return {
    order: of,
    make: (cell) => cell.appendChild(stateMark('unknown')),
    update: (cell, row, mark) => {
      updateState(mark, of(row));
      setAttribute(mark, 'title', row.reason ?? row.health_reason ?? (row.spec && figuresOf(row, app)?.remark) ?? null);
    },
  };
}

/** A bar, and a line of the last minutes where there is room. */
function usage(member, app) {
  const key = member.replace('_mib', '');
  const words = (x) => (key === 'cpu' ? `${number(x.used, 2)} of ${number(x.capacity)}` : ofMebibytes(x));
  return {
    make: (cell) => {
      const parts = { meter: meter(), line: key === 'disk' ? null : sparkline() };
      cell.append(el('div', { class: 'resource' }, parts.meter.root, parts.line?.root ?? ''));
      return parts;
    },
    update: (cell, { identity, resources }, parts) => {
      // Instances change often, and what is used is told seldom.
      if (parts.shown === resources)
        return;
      parts.shown = resources;
      updateMeter(parts.meter, shares(resources)[key], words(resources[member]));
      if (parts.line)
        updateSparkline(parts.line, app.metrics.samples.of(identity.name), key, app.metrics.samples.span());
    },
  };
}

function programs(ends) {
  return ends.map((x) => `${x.program}${x.reliability === 'best_effort' ? ' (best effort)' : ''}`).join(', ') || 'nobody';
}

function gpuWords(gpus) {
  return gpus.map((x) => (x.memory_mib ? ofMebibytes(x.memory_mib) : x.name ?? 'shared memory')).join(', ') || '–';
}

function notRunning(instances) {
  return instances.filter((x) => instanceState(x) !== 'running');
}

/** "2 of 3: camera failed". */
function runningWords(instances) {
  const rows = notRunning(instances);
  const words = rows.slice(0, 3).map((x) => `${x.spec.step} ${spoken(instanceState(x))}`);
  return `${instances.length - rows.length} of ${instances.length}${words.length ? `: ${words.join(', ')}` : ''}`
    + (rows.length > 3 ? ` and ${rows.length - 3} more` : '');
}
