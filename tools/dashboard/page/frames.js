// Work that comes in bursts is done once before the next picture.

export function onceAFrame(work) {
  let planned = false;
  return () => {
    if (planned)
      return;
    planned = true;
    // A hidden page draws no frames, but its title and its words go on.
    const later = document.hidden ? (run) => setTimeout(run, 250) : requestAnimationFrame;
    later(() => {
      planned = false;
      work();
    });
  };
}

export function debounced(work, milliseconds) {
  let timer;
  return (...parts) => {
    clearTimeout(timer);
    timer = setTimeout(() => work(...parts), milliseconds);
  };
}
