// Where in a JSON text each value stands, so that what is wrong with a request
// can be shown at its place.

const SPACE = /[ \t\r\n]*/y;
const STRING = /"(?:[^"\\\u0000-\u001f]|\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4}))*"/y;
const PLAIN = /-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?|true|false|null/y;

export class JsonProblem extends Error {
  constructor(words, at) {
    super(words);
    this.at = at;
  }
}

/** A map from JSON pointers to [from, to] in the text. Throws what is no JSON, with its place. */
export function placesIn(text) {
  const reader = { text, at: 0, places: new Map() };
  readValue(reader, '');
  if (reader.at < text.length)
    throw new JsonProblem('something stands behind the end of the document', reader.at);
  return reader.places;
}

/** The place of a pointer, or of the nearest thing around it that is there. */
export function placeOf(places, pointer) {
  let where = pointer;
  while (!places.has(where) && where)
    where = where.slice(0, where.lastIndexOf('/'));
  return places.get(where) ?? [0, 0];
}

export function lineOf(text, at) {
  return text.slice(0, at).split('\n').length;
}

function readValue(reader, pointer) {
  skip(reader, SPACE);
  const from = reader.at;
  const first = reader.text[from];
  if (first === '{')
    readAll(reader, '}', () => readMember(reader, pointer));
  else if (first === '[')
    readList(reader, pointer);
  else if (!skip(reader, STRING) && !skip(reader, PLAIN))
    throw new JsonProblem('expected a value', from);
  reader.places.set(pointer, [from, reader.at]);
  skip(reader, SPACE);
}

function readList(reader, pointer) {
  let index = 0;
  readAll(reader, ']', () => readValue(reader, `${pointer}/${index++}`));
}

function readMember(reader, pointer) {
  skip(reader, SPACE);
  const from = reader.at;
  if (!skip(reader, STRING))
    throw new JsonProblem('expected a name in quotes', from);
  const name = JSON.parse(reader.text.slice(from, reader.at));
  skip(reader, SPACE);
  expect(reader, ':');
  readValue(reader, `${pointer}/${name.replaceAll('~', '~0').replaceAll('/', '~1')}`);
}

/** What stands between brackets, with commas. */
function readAll(reader, end, readOne) {
  reader.at += 1;
  skip(reader, SPACE);
  if (reader.text[reader.at] === end) {
    reader.at += 1;
    return;
  }
  for (;;) {
    readOne();
    if (reader.text[reader.at] === end)
      break;
    expect(reader, ',', end);
  }
  reader.at += 1;
}

function expect(reader, mark, other) {
  if (reader.text[reader.at] !== mark)
    throw new JsonProblem(`expected '${mark}'${other ? ` or '${other}'` : ''}`, reader.at);
  reader.at += 1;
}

function skip(reader, pattern) {
  pattern.lastIndex = reader.at;
  const found = pattern.exec(reader.text);
  if (found)
    reader.at = pattern.lastIndex;
  return Boolean(found);
}
