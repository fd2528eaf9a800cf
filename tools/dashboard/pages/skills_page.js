// The builds of skills: what nodes have, what was added to the cell, who keeps it,
// where it is on its way to and what runs of it.
import { el, setText } from '../page/dom.js';
import { throttled } from '../page/frames.js';
import { Table } from '../page/table.js';
import { count, mebibytes } from '../page/words.js';
import { SearchField } from './search_field.js';

const AGAIN_MS = 2000;
const DIGITS = 12;
const MIB = 2 ** 20;

const listed = (x = []) => x.join(', ');
const version = (x = '') => (x.length === 64 ? x.slice(0, DIGITS) : x);

const COLUMNS = [
  ['Operation', (x) => x.skill.descriptor.operation], ['Version', (x) => version(x.skill.version)],
  ['Built for', (x) => listed(x.skill.architectures) || 'any'], ['Build', (x) => x.hash.slice(0, DIGITS)],
  ['Size', (x) => (x.bytes ? mebibytes(x.bytes / MIB) : ''), (x) => x.bytes ?? -1], ['Nodes', (x) => listed(x.nodes)],
  ['Kept on', (x) => listed(x.keepers)], ['On its way to', (x) => listed(x.coming_to)],
  ['Instances', (x) => x.instances ?? '', (x) => x.instances ?? -1],
].map(([title, text, order = text]) => ({ title, text, order, class: order === text ? null : 'number' }));

/** One row for each build, whether nodes have it as a skill, or the cell has it. */
function buildsOf({ skills, cellBuilds }) {
  const rows = new Map();
  for (const { skill, nodes } of skills)
    rows.set(skill.hash, { skill, nodes, hash: skill.hash });
  for (const { build, ...about } of cellBuilds)
    rows.set(build.hash, { ...rows.get(build.hash), ...about, hash: build.hash, bytes: build.bytes });
  return [...rows.values()];
}

export class SkillsPage {
  constructor(app) {
    this.app = app;
    this.find = new SearchField('operation, version, build, node …', () => this.draw());
    this.words = el('span', { class: 'soft', role: 'status' });
    this.table = new Table({ caption: 'Skills', columns: COLUMNS, keyOf: (x) => x.hash, empty: 'No skill is known.' });
    this.root = el('div', { class: 'page' }, el('h1', {}, 'Skills'),
      el('p', { class: 'filters' }, this.find.parts, this.words), this.table.root);
    this.again = throttled(() => app.questions.want('skills'), AGAIN_MS);
    this.again();
  }

  update(kinds) {
    if (kinds.has('instances'))
      this.again();
    if (kinds.has('skills') || kinds.has('all'))
      this.draw();
  }

  draw() {
    const rows = buildsOf(this.app.store).filter((x) => this.find.fits(JSON.stringify(x).toLowerCase()));
    this.table.update(rows);
    setText(this.words, count(rows.length, 'build'));
  }
}
