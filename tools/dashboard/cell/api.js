// Questions to the node that serves this page. All paths are relative, so that
// the page works below whatever prefix it is served, a secret one included.
const base = new URL('../v1/', document.baseURI);

const ANSWER_MS = 15000;

/** The node understood, and said no: the `error` object of its reply. */
export class Refusal extends Error {
  constructor(error, status) {
    super(error.message);
    this.error = error;
    this.code = error.code;
    this.status = status;
  }
}

/** Nobody answered, or something that is no node. */
export class NoAnswer extends Error {}

export async function get(path, milliseconds = ANSWER_MS) {
  return read(await ask(path, { signal: AbortSignal.timeout(milliseconds) }));
}

/** Sends a request document. It may take minutes, so only `signal` ends the wait. */
export async function send(text, signal) {
  return read(await ask('requests', {
    method: 'POST', body: text, signal,
    headers: { 'Content-Type': 'application/json' },
  }));
}

/** An answer without an end: gives its text to `onText` as it comes. */
export async function follow(path, { signal, onOpen, onText }) {
  const response = await ask(path, { signal });
  if (!response.ok)
    await read(response);
  onOpen?.();
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  for (;;) {
    const { value, done } = await reader.read();
    if (done)
      return;
    onText(value);
  }
}

async function ask(path, options) {
  try {
    return await fetch(new URL(path, base), { cache: 'no-store', credentials: 'same-origin', ...options });
  } catch (problem) {
    if (options.signal?.aborted && problem.name === 'AbortError')
      throw problem;
    throw new NoAnswer('the node does not answer');
  }
}

async function read(response) {
  let body;
  try {
    body = await response.json();
  } catch (problem) {
    if (problem.name === 'AbortError')
      throw problem;
    throw new NoAnswer(`the answer cannot be read (HTTP ${response.status})`);
  }
  if (body?.type === 'error')
    throw new Refusal(body.error, response.status);
  return body;
}
