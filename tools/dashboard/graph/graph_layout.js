// Where everything of a task's picture stands. The steps stand one below the
// other, in the order in which the coordinator lists them: each below those that
// it gets something from. They stand in the column of their node; a stream has a
// lane at the left, from the step that writes it to those that read it. `roscell
// graph` draws it by the same rules.
import { asList } from '../page/words.js';

export const LINE = 16;
export const BOX = { width: 286, head: 3 };
const COLUMN = BOX.width + 24;
const LANE = 13;
const HEADING = 34;
const GAP = 14;

/** The rows of a task's instances. Gives places in pixels; draws nothing. */
export function layOut(instances) {
  const boxes = instances.map(boxOf);
  const nodes = [...new Set(boxes.map((x) => x.row.node))];
  let bottom = HEADING;
  for (const box of boxes) {
    box.y = bottom;
    box.height = LINE * (BOX.head + box.ends.length) + 12;
    box.ends.forEach((end, i) => { end.y = box.y + LINE * (BOX.head + i) + 12; });
    bottom += box.height + GAP;
  }
  const lanes = lanesOf(boxes);
  const left = 24 + LANE * (1 + Math.max(-1, ...lanes.map((x) => x.column)));
  boxes.forEach((box) => { box.x = left + COLUMN * nodes.indexOf(box.row.node) + 12; });
  return {
    boxes, height: bottom, width: left + COLUMN * nodes.length + 4,
    columns: nodes.map((node, i) => ({ node, x: left + COLUMN * i, width: COLUMN - 4 })),
    arrows: lanes.flatMap(arrowsOf),
  };
}

function boxOf(row) {
  const ends = (streams, reads) => asList(streams).map((stream) => ({ stream, reads, key: `${stream.protocol} ${stream.endpoint}` }));
  const box = { row, step: row.spec.step, ends: [...ends(row.spec.input, true), ...ends(row.spec.output, false)] };
  box.ends.forEach((end) => { end.box = box; });
  return box;
}

/** Those streams that are written and read here; lanes beside each other have columns of their own. */
function lanesOf(boxes) {
  const lanes = new Map();
  for (const end of boxes.flatMap((x) => x.ends))
    lanes.set(end.key, [...lanes.get(end.key) ?? [], end]);
  const free = [];
  return [...lanes.values()].filter((ends) => ends.some((x) => x.reads) && ends.some((x) => !x.reads)).map((ends) => {
    const found = free.findIndex((y) => y < ends[0].y);
    const column = found < 0 ? free.length : found;
    free[column] = ends.at(-1).y;
    return { ends, column };
  });
}

function arrowsOf({ ends, column }) {
  const x = 12 + LANE * column;
  return ends.filter((from) => !from.reads).flatMap((from) => ends.filter((to) => to.reads).map((to) => ({
    from, to, key: `${from.box.step} ${to.box.step} ${to.key}`,
    path: `M${from.box.x} ${from.y}H${x}V${to.y}H${to.box.x - 2}`,
  })));
}

/** The last words of an endpoint: what tells it from its siblings. */
export function shortName(endpoint, most = 24) {
  if (endpoint.length <= most)
    return endpoint;
  const words = endpoint.split('/');
  let text = words.pop();
  while (words.length > 0 && text.length + words.at(-1).length + 2 < most)
    text = `${words.pop()}/${text}`;
  return text.length + 2 > most ? `…${text.slice(-(most - 1))}` : `…/${text}`;
}
