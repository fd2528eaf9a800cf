// The cells of the site, and the nodes of this one.
import { el, keyed, setAttribute, setText } from '../page/dom.js';
import { stateMark, updateState } from '../page/marks.js';
import { address, way } from '../page/router.js';
import { Table } from '../page/table.js';
import { count, instanceState, kindOf } from '../page/words.js';
import { columnsOf } from './columns.js';
import { EventRows, isEcho } from './event_rows.js';

const MOST_PROBLEMS = 12;
const SHOWN = 8;

export class SitePage {
  constructor(app) {
    this.app = app;
    this.title = el('h1', {}, 'Site');
    this.cells = el('ul', { class: 'cards' });
    this.table = new Table({
      caption: 'Nodes of the cell', columns: columnsOf('nodes', app), keyOf: (x) => x.identity.name,
      href: (x) => address('nodes', x.identity.name), empty: 'No node is known yet.',
    });
    this.free = el('ul', { class: 'cards' });
    this.freeBox = el('section', {}, el('h2', {}, 'Nodes in no cell'), this.free);
    this.problems = el('ul', { class: 'problems' });
    this.calm = el('p', { class: 'soft' });
    this.rows = new EventRows(SHOWN);
    this.root = el('div', { class: 'page with-side' }, this.title,
      el('div', { class: 'wide' },
        el('section', {}, el('h2', { id: 'cells' }, 'Cells'), this.cells),
        el('section', {}, el('h2', {}, 'Nodes'), this.table.root), this.freeBox),
      el('aside', { 'aria-label': 'What needs attention' },
        el('section', {}, el('h2', {}, 'Needs attention'), this.calm, this.problems),
        el('section', {}, el('h2', {}, 'Last events'), this.rows.root,
          el('p', {}, el('a', { href: address('events') }, 'All events')))));
    app.metrics.request('resources');
  }

  update() {
    const { store } = this.app;
    keyed(this.cells, store.cells, (x) => x.cell, makeCell, (card, x) => updateCell(card, x, store.cell?.cell));
    this.table.update([...store.nodes.values()]);
    this.freeBox.hidden = store.free.length === 0;
    keyed(this.free, store.free, (x) => x.uuid, makeFree, updateFree);
    const problems = problemsOf(store);
    setText(this.calm, store.cell && problems.length === 0 ? 'Nothing: all nodes are there, all tasks run.' : '');
    keyed(this.problems, problems.slice(0, MOST_PROBLEMS), (x) => x.key, makeProblem, updateProblem);
    this.rows.update(store.events.slice(-3 * SHOWN).filter((x) => !isEcho(x, store)).slice(-SHOWN).reverse());
  }
}

function makeCell() {
  const parts = {
    name: el('b', {}), here: el('span', { class: 'tag' }, 'this cell'), size: el('span', {}),
    about: el('span', { class: 'soft' }), problem: el('p', { class: 'state warn' }),
  };
  const card = el('li', { class: 'card' }, el('p', {}, parts.name, ' ', parts.here, ' ', parts.size), el('p', {}, parts.about), parts.problem);
  card.parts = parts;
  return card;
}

function updateCell({ parts }, row, own) {
  setText(parts.name, row.cell);
  parts.here.hidden = row.cell !== own;
  setText(parts.size, count(row.size, 'node'));
  setText(parts.about, `coordinator ${row.coordinator}, ${row.address}`);
  setText(parts.problem, row.trouble ?? '');
  parts.problem.hidden = !row.trouble;
}

function makeFree(row) {
  const parts = { state: stateMark(row.state), about: el('span', { class: 'soft' }) };
  const card = el('li', { class: 'card' },
    el('p', {}, el('b', {}, row.name), ' ', parts.state), el('p', {}, parts.about),
    el('p', {}, way('Bring into this cell', 'requests', 'cell_formation', { members: row.name })));
  card.parts = parts;
  return card;
}

function updateFree({ parts }, row) {
  updateState(parts.state, row.silent_since_unix_ms ? 'away' : row.state);
  setText(parts.about, `${row.address}${row.cell ? `, was in ${row.cell}` : ''}`);
}

/** What somebody should look at, the worst first. */
function problemsOf(store) {
  const nodes = [...store.nodes.values()].filter((x) => x.state === 'lost').map((x) => ({
    key: `node ${x.identity.name}`, state: 'lost', href: address('nodes', x.identity.name),
    name: `Node ${x.identity.name}`, words: x.reason ?? '',
  }));
  const tasks = [...store.tasks.values()].filter((x) => x.state === 'failed').map((x) => ({
    key: `task ${x.task}`, state: 'failed', href: address('tasks', x.task), name: `Task ${x.task}`, words: '',
  }));
  const instances = [...store.instances.values()]
    .filter((x) => ['warn', 'bad', 'unknown'].includes(kindOf(instanceState(x))) || x.waits)
    .filter((x) => store.tasks.get(x.spec.task)?.state !== 'failed')
    .map((x) => ({
      key: `instance ${x.spec.instance}`, state: instanceState(x), href: address('instances', x.spec.instance),
      name: `${x.spec.task} / ${x.spec.step}`, words: x.waits ?? x.health_reason ?? x.reason ?? `on ${x.node}`,
    }));
  return [...nodes, ...tasks, ...instances, ...refusedSkills(store)];
}

/** A folder that is wrong on many nodes is one problem. */
function refusedSkills({ refusedSkills: rows }) {
  const folders = new Map();
  for (const { node, problem } of rows)
    folders.set(problem.path, { problem, nodes: new Set([...folders.get(problem.path)?.nodes ?? [], node]) });
  return [...folders].map(([path, { problem, nodes }]) => ({
    key: `skill ${path}`, state: 'refused', href: address('plan'), name: `Skill in ${path}`,
    words: `${problem.message}, on ${[...nodes].join(', ')}`,
  }));
}

function makeProblem() {
  const parts = { link: el('a', {}), state: stateMark('unknown'), words: el('span', { class: 'soft' }) };
  const item = el('li', {}, el('p', {}, parts.state, ' ', parts.link), el('p', {}, parts.words));
  item.parts = parts;
  return item;
}

function updateProblem({ parts }, problem) {
  setAttribute(parts.link, 'href', problem.href);
  setText(parts.link, problem.name);
  updateState(parts.state, problem.state);
  setText(parts.words, problem.words);
}
