// Where everything of a task's picture stands: nodes are bands from top to
// bottom, data flows from left to right.

export const BOX = { width: 176, height: 62 };
const END = { width: 156 };
/** Between columns: room for a label and a curve, or for a short arrow. */
const LABEL = { width: 156, before: 14 };
const GAP = { wide: LABEL.before + LABEL.width + 60, narrow: 36 };
const ROW = 18;
const BAND = { label: 30, padding: 14, gap: 10 };
const LEFT = 18;
const LINE = 15;

/** `graph` as task_graph.js makes it. Gives places in pixels; draws nothing. */
export function layOut(graph) {
  const items = itemsOf(graph);
  const columns = columnsOf(items, graph);
  const bands = bandsOf(items, columns);
  let y = 8;
  for (const band of bands) {
    band.y = y;
    band.height = placeBand(band, columns, y);
    y += band.height + BAND.gap;
  }
  const byKey = new Map(items.map((x) => [x.key, x]));
  const arrows = arrowsOf(graph, byKey);
  const width = placeColumns(items, columns, arrows);
  spreadLabels(arrows);
  arrows.forEach((x) => { x.path = x.to.x > x.from.x ? pathOn(x) : pathBack(x); });
  return { width, height: y, bands, items, arrows };
}

function itemsOf({ steps, ends }) {
  return [
    ...steps.map((step) => ({ key: step.id, kind: 'step', node: step.node, step, ...BOX })),
    ...ends.map((end) => ({
      key: `${end.side} ${end.step}`, kind: 'end', end, ...END,
      height: 14 + LINE * Math.min(3, end.streams.length),
      node: steps.find((x) => x.id === end.step).node,
    })),
  ];
}

function linksOf({ flows, ends }) {
  return [
    ...flows.map((x) => [x.from, x.to]),
    ...ends.map((x) => (x.side === 'in' ? [`in ${x.step}`, x.step] : [x.step, `out ${x.step}`])),
  ];
}

/** The longest way to each item; arrows that lead back do not count. */
function columnsOf(items, graph) {
  const columns = new Map();
  const before = new Map(items.map((x) => [x.key, []]));
  for (const [from, to] of linksOf(graph))
    before.get(to)?.push(from);
  const open = new Set();
  const columnOf = (key) => {
    if (columns.has(key))
      return columns.get(key);
    if (open.has(key) || !before.has(key))
      return -1;
    open.add(key);
    const column = 1 + Math.max(-1, ...before.get(key).map(columnOf));
    open.delete(key);
    columns.set(key, column);
    return column;
  };
  items.forEach((x) => columnOf(x.key));
  pullInputs(items, graph, columns);
  return columns;
}

/** What comes from outside stands right before the step that reads it. */
function pullInputs(items, graph, columns) {
  for (const { end, key } of items)
    if (end?.side === 'in')
      columns.set(key, Math.max(0, columns.get(end.step) - 1));
}

function bandsOf(items, columns) {
  const bands = new Map();
  for (const item of [...items].sort((a, b) => columns.get(a.key) - columns.get(b.key))) {
    const band = bands.get(item.node) ?? { node: item.node, items: [] };
    band.items.push(item);
    bands.set(item.node, band);
  }
  return [...bands.values()];
}

/** Items of one column of a band stand below each other. Gives the band's height. */
function placeBand(band, columns, top) {
  const bottoms = new Map();
  for (const item of band.items) {
    const column = columns.get(item.key);
    const y = bottoms.get(column) ?? top + BAND.label;
    item.y = y;
    bottoms.set(column, y + item.height + ROW);
  }
  return Math.max(...bottoms.values()) - ROW + BAND.padding - top;
}

/** A gap is wide where a label begins in it. Gives the picture's width. */
function placeColumns(items, columns, arrows) {
  const labelled = new Set(arrows.filter((x) => x.labelled).map((x) => columns.get(x.from.key)));
  const last = Math.max(0, ...items.map((x) => columns.get(x.key)));
  let x = LEFT;
  for (let column = 0; column <= last; ++column) {
    items.filter((item) => columns.get(item.key) === column).forEach((item) => { item.x = x; });
    x += widest(items, columns, column) + (labelled.has(column) ? GAP.wide : GAP.narrow);
  }
  return x - (labelled.has(last) ? GAP.wide : GAP.narrow) + LEFT;
}

function widest(items, columns, column) {
  return Math.max(0, ...items.filter((item) => columns.get(item.key) === column).map((item) => item.width));
}

function arrowsOf({ flows, ends }, byKey) {
  const arrow = (from, to, streams, labelled) => ({
    key: `${from}>${to}`, from: byKey.get(from), to: byKey.get(to), streams, labelled,
  });
  return [
    ...flows.map((x) => arrow(x.from, x.to, x.streams, true)),
    ...ends.map((x) => (x.side === 'in' ? arrow(`in ${x.step}`, x.step, x.streams, false)
      : arrow(x.step, `out ${x.step}`, x.streams, false))),
  ];
}

const middle = (item) => item.y + item.height / 2;

/** Labels stand right behind the step that writes, and do not cover each other. */
function spreadLabels(arrows) {
  const gaps = new Map();
  for (const arrow of arrows.filter((x) => x.labelled)) {
    arrow.label = { x: arrow.from.x + BOX.width + LABEL.before + LABEL.width / 2, y: middle(arrow.from) };
    gaps.set(arrow.label.x, [...gaps.get(arrow.label.x) ?? [], arrow]);
  }
  for (const gap of gaps.values()) {
    let free = -Infinity;
    for (const arrow of gap.sort((a, b) => a.label.y - b.label.y || middle(a.to) - middle(b.to))) {
      const half = labelHeight(arrow) / 2 + 4;
      arrow.label.y = Math.max(arrow.label.y, free + half);
      free = arrow.label.y + half;
    }
  }
}

/** To the label, straight through it, and in a curve to the step that reads. */
function pathOn({ from, to, label }) {
  const [x, y, endX, endY] = [from.x + from.width, middle(from), to.x, middle(to)];
  if (!label)
    return `M${x} ${y}C${x + 20} ${y} ${endX - 20} ${endY} ${endX} ${endY}`;
  const out = x + LABEL.before + LABEL.width;
  const bend = Math.min(60, (endX - out) / 2);
  return `M${x} ${y}L${x + LABEL.before} ${label.y}H${out}C${out + bend} ${label.y} ${endX - bend} ${endY} ${endX} ${endY}`;
}

/** What leads back goes around, below both steps. */
function pathBack({ from, to }) {
  const low = Math.max(from.y + from.height, to.y + to.height) + 14;
  return `M${from.x + from.width} ${middle(from)}C${from.x + from.width + 60} ${low} ${to.x - 60} ${low} ${to.x} ${middle(to)}`;
}

/** A line for each stream, at most three, and one for the metrics. */
export function labelHeight(arrow) {
  return LINE * (Math.min(3, arrow.streams.length) + 1);
}
