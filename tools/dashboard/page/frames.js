// Work that comes in bursts is done once before the next picture.

/** A hidden page draws no frames, but its title and its words go on. */
const WITHOUT_FRAMES_MS = 250;

export function onceAFrame(work) {
  let planned = false;
  return () => {
    if (planned)
      return;
    planned = true;
    // It may be hidden after this, so both are waited for, whichever comes first.
    const run = () => {
      cancelAnimationFrame(frame);
      clearTimeout(timer);
      planned = false;
      work();
    };
    const frame = requestAnimationFrame(run);
    const timer = setTimeout(run, WITHOUT_FRAMES_MS);
  };
}

/** For what a person does step by step: only after the last step. */
export function debounced(work, milliseconds) {
  let timer;
  return (...parts) => {
    clearTimeout(timer);
    timer = setTimeout(() => work(...parts), milliseconds);
  };
}

/** For what may never pause: once in so long, and so long after the first call at the latest. */
export function throttled(work, milliseconds) {
  let timer = null;
  return () => {
    timer ??= setTimeout(() => {
      timer = null;
      work();
    }, milliseconds);
  };
}
