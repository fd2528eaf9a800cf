// Says aloud, to whoever listens to the page, what matters at once: a node that
// dies, a task that fails. Everything else would be noise.
import { setText } from './dom.js';

const WORDS = {
  node_lost: (x) => `Node ${x.subject} is lost: ${x.data?.reason ?? ''}`,
  node_joined: (x) => `Node ${x.subject} has joined`,
  node_left: (x) => `Node ${x.subject} has left`,
  task_accepted: (x) => `Task ${x.subject} runs`,
  task_failed: (x) => `Task ${x.subject} has failed: ${x.data?.reason ?? ''}`,
  task_finished: (x) => `Task ${x.subject} is finished`,
  task_terminated: (x) => `Task ${x.subject} is gone`,
  step_stranded: (x) => `A step has no place: ${x.subject}`,
};

export class Announcer {
  constructor(element) {
    this.element = element;
  }

  say(words) {
    setText(this.element, '');
    setTimeout(() => setText(this.element, words), 50);
  }

  hear(events) {
    const words = events.filter((x) => WORDS[x.event]).slice(-3).map((x) => WORDS[x.event](x));
    if (words.length > 0)
      this.say(words.join('. '));
  }
}
