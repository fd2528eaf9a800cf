// Asks the node again for what an event says has changed. Questions that come
// together are asked together and once: two rounds a second at most, and so
// seldom that answering them keeps the node below a hundredth of a core.
import { get, NoAnswer, Refusal } from './api.js';

const ROUND_MS = 500;
/** With more tasks to ask for than this, one question for all is cheaper. */
const MOST_TASKS = 5;

export class Questions {
  constructor(store, onProblem) {
    this.store = store;
    this.onProblem = onProblem;
    this.wanted = new Map();
    this.earliest = new Map();
    this.timer = null;
    this.asking = false;
  }

  /** `ask('cell')`, or `ask('task', name)`. */
  ask = (kind, name) => {
    this.store.flights.note(kind, name);
    this.want(kind, name);
  };

  want = (kind, name) => {
    this.wanted.set(name === undefined ? kind : `${kind} ${name}`, { kind, name });
    this.timer ??= setTimeout(() => this.round(), ROUND_MS);
  };

  /** Reads everything, when the page opens or the node is back. */
  async readAll() {
    await Promise.all(['cell', 'cells', 'skills'].map((kind) => this.askOne({ kind })));
  }

  async round() {
    this.timer = null;
    if (this.asking)
      return;
    this.asking = true;
    const due = this.takeDue();
    await Promise.all(due.map((question) => this.askOne(question)));
    this.asking = false;
    if (this.wanted.size > 0)
      this.timer ??= setTimeout(() => this.round(), ROUND_MS);
  }

  takeDue() {
    for (const [key, { kind, name }] of this.wanted)
      if (kind === 'task' && this.store.ended.has(name))
        this.wanted.delete(key);
    const tasks = [...this.wanted].filter(([, x]) => x.kind === 'task');
    if (this.wanted.has('cell') || tasks.length > MOST_TASKS) {
      tasks.forEach(([key]) => this.wanted.delete(key));
      if (!this.wanted.has('cell'))
        this.wanted.set('tasks', { kind: 'tasks' });
    }
    const due = [];
    for (const [key, question] of [...this.wanted]) {
      if ((this.earliest.get(question.kind) ?? 0) > Date.now())
        continue;
      this.wanted.delete(key);
      due.push(question);
    }
    return due;
  }

  async askOne({ kind, name }) {
    const begun = Date.now();
    try {
      await this.store.flights.during(() => ANSWERS[kind](this.store, name), this.want);
    } catch (problem) {
      if (problem instanceof Refusal && problem.code === 'unknown_task')
        this.store.dropTask(name);
      else if (problem instanceof NoAnswer)
        this.onProblem(problem);
    }
    // Large answers are asked for less often; a task's is small.
    if (kind !== 'task')
      this.earliest.set(kind, Date.now() + 20 * (Date.now() - begun));
  }
}

const ANSWERS = {
  cell: async (store) => store.setCell(await get('cell')),
  tasks: async (store) => store.setTasks((await get('tasks')).tasks),
  task: async (store, name) => {
    for (const row of (await get(`tasks/${encodeURIComponent(name)}`)).tasks)
      store.putTask(row);
  },
  cells: async (store) => {
    store.cells = (await get('cells')).cells;
    store.touch('cells');
  },
  skills: async (store) => {
    const list = await get('skills');
    store.skills = list.skills;
    store.refusedSkills = list.refused ?? [];
    store.cellBuilds = list.builds ?? [];
    store.touch('skills');
  },
  node: async (store) => {
    store.me = await get('node');
    store.touch('me');
  },
};
