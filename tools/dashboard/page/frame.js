// What stays while pages change: the way between them, how the node is reached,
// help, theme, shortcuts.
import { button, el, replace, setAttribute, setText } from './dom.js';
import { openHelp } from './help.js';
import { stateMark, updateState } from './marks.js';
import { address } from './router.js';
import { Shortcuts } from './shortcuts.js';
import { setUpTheme } from './theme.js';
import { clock, count } from './words.js';

const WAYS = [
  ['site', 'Site', 's', 'cells and nodes'], ['tasks', 'Tasks', 't', 'tasks'],
  ['instances', 'Instances', 'i', 'instances'], ['topics', 'Topics', 'o', 'topics'],
  ['skills', 'Skills', 'k', 'skills'],
  ['events', 'Events', 'e', 'events'], ['plan', 'New task', 'n', 'a new task, and where it would go'],
  ['requests', 'Requests', 'r', 'requests to nodes and tasks'],
];

/** Pages that belong to an entry of the menu without being one. */
const PARENT = { nodes: 'site' };

export class Frame {
  constructor(app, stream) {
    this.app = app;
    this.stream = stream;
    this.main = document.getElementById('page');
    this.links = new Map();
    document.getElementById('ways').append(...WAYS.map((way) => this.makeWay(way)));
    this.link = stateMark('connecting');
    document.getElementById('link').append(this.link);
    this.banner = document.getElementById('banner');
    this.look = button('Look now', () => stream.lookNow());
    this.words = el('span', { role: 'alert' });
    // It changes each second, and is not read aloud each time.
    this.countdown = el('span', {});
    this.banner.append(this.words, this.countdown, this.look);
    document.querySelector('.skip').addEventListener('click', (event) => this.skip(event));
    this.setUpKeys(setUpTheme(document.getElementById('theme')));
    // How long a node has been away is told anew each second, and only then.
    setInterval(() => this.store.link.state === 'away' && this.showLink(), 1000);
  }

  get store() {
    return this.app.store;
  }

  makeWay([page, title]) {
    const amount = el('span', { class: 'amount' });
    const link = el('a', { href: address(page) }, el('span', {}, title), amount);
    this.links.set(page, { link, amount });
    return el('li', {}, link);
  }

  setUpKeys(nextTheme) {
    const keys = new Shortcuts();
    for (const [page, , key, meaning] of WAYS)
      keys.add(`g ${key}`, `Go to ${meaning}`, () => this.app.go(address(page)));
    keys.add('/', 'Filter what is shown', () => this.main.querySelector('input[type=search]')?.focus());
    keys.add('n', 'A new task', () => this.app.go(address('plan')));
    keys.add('m', 'Change the theme', () => this.app.announcer.say(`Theme: ${nextTheme()}`));
    keys.add('?', 'This help', () => openHelp(keys));
    document.getElementById('help').addEventListener('click', () => openHelp(keys));
  }

  /** The address stays that of the page, which is not made anew. */
  skip(event) {
    event.preventDefault();
    this.main.focus();
  }

  show(where, page) {
    replace(this.main, page.root);
    this.mark(where);
    window.scrollTo(0, 0);
    // Who listens to the page hears where it is now.
    const title = page.root.querySelector('h1');
    if (title && this.shown) {
      title.tabIndex = -1;
      title.focus({ preventScroll: true });
    }
    this.shown = true;
  }

  mark(where) {
    const here = PARENT[where.page] ?? where.page;
    for (const [page, { link }] of this.links)
      setAttribute(link, 'aria-current', page === here ? 'page' : null);
    this.links.get(here)?.link.scrollIntoView({ block: 'nearest', inline: 'nearest' });
  }

  update(kinds) {
    const { store } = this;
    if (kinds.has('link'))
      this.showLink();
    if (store.cell) {
      setText(document.getElementById('cell-name'), store.cell.cell);
      setText(document.getElementById('node-name'), store.me ? `by ${store.me.identity.name}` : '');
    }
    const lost = [...store.nodes.values()].filter((x) => x.state === 'lost').length;
    const withProblems = [...store.tasks.values()].filter((x) => ['failed', 'degraded'].includes(x.state)).length;
    this.showAmount('site', lost, count(lost, 'lost node'));
    this.showAmount('tasks', withProblems, `${count(withProblems, 'task')} with problems`);
  }

  showAmount(page, amount, meaning) {
    const element = this.links.get(page).amount;
    setText(element, amount || '');
    setAttribute(element, 'title', amount ? meaning : null);
    setAttribute(element, 'aria-label', amount ? meaning : null);
  }

  showLink() {
    const { state, since, retryAt } = this.store.link;
    updateState(this.link, state);
    this.banner.hidden = state !== 'away';
    document.body.classList.toggle('stale', state === 'away');
    if (state !== 'away')
      return;
    setText(this.words, `The node has not answered since ${clock(since)}: what is shown is as it was then.`);
    setText(this.countdown, `Looking again in ${Math.max(0, Math.ceil((retryAt - Date.now()) / 1000))} s.`);
  }
}
