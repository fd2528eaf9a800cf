// One instance: what it is, what it does, how it ended before, and its log.
import { attributes, el, keyed, remade, setText } from '../page/dom.js';
import { stateMark, updateState } from '../page/marks.js';
import { address, way } from '../page/router.js';
import { ago, asList, clock, dateAndTime, hertz, instanceState, mebibytes, milliseconds, number } from '../page/words.js';
import { LogView } from './log_view.js';

export class InstancePage {
  constructor(app, where) {
    this.app = app;
    this.name = where.name;
    this.title = el('span', {}, this.name);
    this.state = stateMark('unknown');
    this.reason = el('p', { class: 'reason' });
    this.metrics = el('p', { class: 'figure-row' });
    this.actions = el('p', { class: 'actions' });
    this.attributes = el('div', {});
    this.ends = el('div', {});
    this.endsBox = el('section', { hidden: true }, el('h2', {}, 'Earlier ends'), this.ends);
    this.log = new LogView(this.name, () => this.lives());
    this.root = el('div', { class: 'page' },
      el('p', { class: 'way' }, el('a', { href: address('instances') }, 'Instances')),
      el('h1', {}, this.title, ' ', this.state), this.reason, this.metrics, this.actions,
      el('section', {}, el('h2', {}, 'Log'), this.log.root),
      this.endsBox, el('section', {}, el('h2', {}, 'About'), this.attributes));
  }

  close() {
    this.pause();
  }

  /** Lets the node go until the link is live again. */
  pause() {
    this.log.stop();
  }

  /** Until the cell is known nobody can say that it has ended. */
  lives() {
    const { store } = this.app;
    const row = store.instances.get(this.name);
    return row ? !['stopped', 'failed'].includes(row.state) : !store.cell;
  }

  update() {
    const linked = this.app.store.link.state;
    if (linked === 'live' && this.linked !== 'live')
      this.log.again();
    this.linked = linked;
    const row = this.app.store.instances.get(this.name);
    if (Boolean(row) !== this.there)
      this.app.metrics.request(row && { instance: this.name });
    this.there = Boolean(row);
    if (!row)
      return this.app.store.cell && this.showAbsence();
    const state = instanceState(row);
    updateState(this.state, state);
    setText(this.title, `${row.spec.task} / ${row.spec.step}`);
    setText(this.reason, reasonOf(row, this.app.store.metrics.get(this.name)));
    this.showMetrics(row);
    if (this.known !== state && state === 'running')
      this.log.again();
    this.known = state;
    this.readEnds(row);
    this.showActions(row);
    this.showAbout(row);
    this.showEnds(row.ends ?? []);
  }

  showAbsence() {
    updateState(this.state, 'stopped');
    setText(this.reason, 'The cell has no instance of that name now; its log may still be there.');
    const next = this.replacement();
    remade(this.actions, [next], () => this.wayOn(next));
  }

  /** What runs the same step now; an id is the task's, the step's and eight digits. */
  replacement() {
    const begin = this.name.slice(0, -8);
    return [...this.app.store.instances.values()].map((x) => x.spec)
      .find((x) => x.instance !== this.name && `${x.task}-${x.step}-` === begin)?.instance;
  }

  wayOn(next) {
    return next && way('What runs in its place', 'instances', next);
  }

  /** No event tells how it ended. */
  readEnds({ spec, restarts = 0, state }) {
    const run = `${restarts} ${state}`;
    if (this.run !== undefined && this.run !== run)
      this.app.questions.ask('task', spec.task);
    this.run = run;
  }

  showMetrics(row) {
    const x = this.app.store.metrics.get(this.name) ?? row.figures ?? {};
    const { use = {} } = x;
    const asked = row.spec.resources;
    const told = (value, words, of) => value !== undefined && `${words(value, 9)} ${of}`;
    setText(this.metrics, [
      hertz(x.rate_hz),
      told(x.latency_ms, milliseconds, 'to process'),
      told(x.age_ms, milliseconds, 'old at the output'),
      told(x.frames, number, 'frames'),
      told(x.dropped, number, 'dropped'),
      told(use.memory_mib, mebibytes, `of ${mebibytes(use.memory_limit_mib ?? asked.memory_mib)}`),
      told(use.cpu?.toFixed(2), String, `of ${number(asked.cpu)} cores`),
      row.restarts && `started again ${row.restarts} times`,
    ].filter(Boolean).join('   ·   '));
  }

  showActions({ spec, node }) {
    const next = this.lives() ? undefined : this.replacement();
    remade(this.actions, [spec.instance, node, next], () => [this.wayOn(next),
      way('Restart', 'requests', 'task_restart', { task: spec.task, instance: spec.instance }),
      way('Its task', 'tasks', spec.task), way(`Its node, ${node}`, 'nodes', node)]);
  }

  showAbout(row) {
    const { spec } = row;
    const streams = (list) => asList(list).map((x) => el('div', {}, x.endpoint, ' ', el('span', { class: 'soft' }, x.data_type)));
    remade(this.attributes, [spec, row.node, row.since_unix_ms, row.container, row.image], () => attributes([
      ['Instance', spec.instance], ['Task', spec.task], ['Node', row.node],
      ['Skill', `${spec.operation} / ${spec.model} / ${spec.deployment}`], ['Build', spec.skill.slice(0, 16)],
      ['Reads', streams(spec.input)], ['Writes', streams(spec.output)],
      ['Parameters', el('code', {}, JSON.stringify(spec.parameters ?? {}))],
      ['Reserved', `${number(spec.resources.cpu)} cores, ${number(spec.resources.memory_mib)} MiB memory, ${number(spec.resources.disk_mib)} MiB disk`],
      ['GPU', spec.gpu], ['In this state since', dateAndTime(row.since_unix_ms)], ['Runs as', row.container], ['Image', row.image],
      ['Restart', spec.life?.restart?.policy], ['On node loss', spec.life?.on_node_loss?.policy],
    ]));
  }

  showEnds(ends) {
    this.endsBox.hidden = ends.length === 0;
    keyed(this.ends, ends, (x) => x.unix_ms, makeEnd);
  }
}

function reasonOf(row, metrics) {
  const words = [row.waits, row.trouble, row.health_reason, metrics?.remark, row.reason];
  if (row.unknown_since_unix_ms)
    words.unshift(`Its node, ${row.node}, is away since ${clock(row.unknown_since_unix_ms)}; it may run on there.`);
  if (row.state === 'backing_off' && row.next_start_unix_ms)
    words.push(`It is started again at ${clock(row.next_start_unix_ms)}.`);
  if (row.exit_code !== null && row.exit_code !== undefined)
    words.push(`Exit code ${row.exit_code}, ${ago(row.since_unix_ms)} ago.`);
  return words.filter(Boolean).join(' ');
}

function makeEnd(end) {
  return el('details', {}, el('summary', {}, `${dateAndTime(end.unix_ms)}: exit code ${end.exit_code ?? 'unknown'} ${end.reason ?? ''}`),
    el('pre', { class: 'log' }, end.log ?? 'no log'));
}
