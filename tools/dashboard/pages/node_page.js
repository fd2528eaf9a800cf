// One node: what is used of it over the last minutes, what it runs, what can be
// asked of it.
import { shares } from '../cell/samples.js';
import { attributes, el, keyed, remade, setAttribute, setText } from '../page/dom.js';
import { meter, sparkline, stateMark, updateMeter, updateSparkline, updateState } from '../page/marks.js';
import { address, way } from '../page/router.js';
import { ago, dateAndTime, labelWords, nodeState, number, ofMebibytes, percent } from '../page/words.js';
import { instanceTable } from './instances_page.js';

export class NodePage {
  constructor(app, where) {
    this.app = app;
    this.name = where.name;
    this.state = stateMark('unknown');
    this.reason = el('p', { class: 'soft' });
    this.actions = el('p', { class: 'actions' });
    this.charts = el('div', { class: 'charts' });
    this.attributes = el('div', {});
    this.instances = instanceTable(app, 'NODE');
    this.root = el('div', { class: 'page' },
      el('p', { class: 'way' }, el('a', { href: address('site') }, 'Site')),
      el('h1', {}, this.name, ' ', this.state), this.reason, this.actions,
      el('section', {}, el('h2', {}, 'Resources over the last minutes'), this.charts),
      el('section', {}, el('h2', {}, 'Instances'), this.instances.root),
      el('section', {}, el('h2', {}, 'About'), this.attributes));
    app.metrics.request('resources', 'instances');
  }

  update(kinds) {
    const row = this.app.store.nodes.get(this.name);
    if (!row)
      return this.showAbsence();
    updateState(this.state, nodeState(row));
    setText(this.reason, row.reason ? `${row.reason} (${ago(row.since_unix_ms)} ago)` : '');
    keyed(this.charts, chartsOf(row.resources), (x) => x.key, makeChart, (card, x) => this.updateChart(card, x));
    this.instances.update(this.app.store.instancesOn(this.name));
    if (kinds.has('nodes') || kinds.has('all') || kinds.has('skills'))
      this.showFacts(row);
  }

  showAbsence() {
    if (this.app.store.cell)
      setText(this.reason, 'This cell has no node of that name now.');
  }

  updateChart(card, { key, words, share }) {
    updateMeter(card.parts.meter, share, words);
    updateSparkline(card.parts.line, this.app.metrics.samples.of(this.name), key, this.app.metrics.samples.span());
    setText(card.parts.share, percent(share));
  }

  showFacts(row) {
    const { identity, resources, role } = row;
    const skills = this.app.store.skills.filter((x) => x.nodes.includes(this.name)).map((x) => x.skill.descriptor.operation);
    const rows = [
      ['Role', role], ['Address', identity.address], ['Architecture', resources.architecture],
      ['Labels', labelWords(resources.labels)], ['Devices', resources.devices.join(', ')],
      ['GPUs', resources.gpus.map((x) => `${x.index}: ${x.name ?? 'GPU'}`).join(', ')],
      ['Skills', [...new Set(skills)].join(', ')], ['In this state since', dateAndTime(row.since_unix_ms)],
      ['UUID', identity.uuid], ['Epoch', identity.epoch],
    ];
    remade(this.attributes, rows, () => attributes(rows));
    this.showActions(row);
  }

  showActions(row) {
    const request = (type, words) => way(words, 'requests', type, { node: this.name });
    const draining = nodeState(row) === 'draining';
    const coordinator = row.role === 'coordinator';
    remade(this.actions, [draining, coordinator], () => [
      draining ? request('node_undrain', 'Undrain') : request('node_drain', 'Drain'),
      coordinator ? null : request('node_transfer', 'Transfer'), coordinator ? null : request('node_release', 'Release')]);
  }
}

function chartsOf(resources) {
  const share = shares(resources);
  const charts = [
    { key: 'cpu', title: 'CPU', words: `${number(resources.cpu.used, 2)} of ${number(resources.cpu.capacity)} cores` },
    { key: 'memory', title: 'Memory', words: ofMebibytes(resources.memory_mib) },
    { key: 'disk', title: 'Disk', words: ofMebibytes(resources.disk_mib) },
    ...resources.gpus.filter((x) => x.memory_mib)
      .map((x) => ({ key: `gpu_${x.index}`, title: `GPU ${x.index} memory`, words: ofMebibytes(x.memory_mib) })),
  ];
  return charts.map((x) => ({ ...x, share: share[x.key] }));
}

function makeChart({ title }) {
  const parts = { meter: meter(), line: sparkline(60), share: el('b', {}) };
  const card = el('figure', { class: 'chart' }, el('figcaption', {}, title, ' ', parts.share), parts.line.root, parts.meter.root);
  setAttribute(card, 'aria-label', title);
  card.parts = parts;
  return card;
}
