// Dragging by mouse, pen or finger; by a finger at the grip only, for elsewhere it
// scrolls the page. Whatever can be dragged has a button that does the same.
import { el } from '../page/dom.js';

const FAR_PX = 6;

export function grip() {
  return el('span', { class: 'grip', 'aria-hidden': 'true' }, '⠿');
}

/** Lets `handle` be dragged; `onDrop(zone)` gets the element of `zones()` that it was dropped on. */
export function makeDraggable(handle, zones, onDrop) {
  handle.addEventListener('pointerdown', (begin) => {
    if (begin.button !== 0 || begin.target.closest('button, input, a'))
      return;
    if (begin.pointerType !== 'mouse' && !begin.target.closest('.grip'))
      return;
    begin.preventDefault();
    handle.setPointerCapture(begin.pointerId);
    let zone = null;
    const onMove = (event) => {
      const x = event.clientX - begin.clientX;
      const y = event.clientY - begin.clientY;
      if (!handle.classList.contains('dragged') && Math.hypot(x, y) < FAR_PX)
        return;
      handle.classList.add('dragged');
      handle.style.translate = `${x}px ${y}px`;
      zone = zoneAt(zones(), event);
      zones().forEach((one) => one.classList.toggle('over', one === zone));
    };
    const onEnd = (event) => {
      handle.removeEventListener('pointermove', onMove);
      handle.classList.remove('dragged');
      handle.style.translate = '';
      zones().forEach((one) => one.classList.remove('over'));
      if (zone && event.type === 'pointerup')
        onDrop(zone);
    };
    handle.addEventListener('pointermove', onMove);
    handle.addEventListener('pointerup', onEnd, { once: true });
    handle.addEventListener('pointercancel', onEnd, { once: true });
  });
}

function zoneAt(zones, { clientX, clientY }) {
  return zones.find((zone) => {
    const box = zone.getBoundingClientRect();
    return clientX >= box.left && clientX <= box.right && clientY >= box.top && clientY <= box.bottom;
  }) ?? null;
}
