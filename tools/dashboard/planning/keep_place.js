// A form that is made anew leaves the keyboard where it was, and open what was open.

/** `make` replaces what is in `root`. */
export function keepingPlace(root, make) {
  const focused = root.contains(document.activeElement) ? document.activeElement : null;
  const place = focused && placeOf(root, focused);
  const selection = focused?.selectionStart === undefined ? null : [focused.selectionStart, focused.selectionEnd];
  const open = new Map([...root.querySelectorAll('details')].map((x) => [placeOf(root, x), x.open]));
  make();
  for (const details of root.querySelectorAll('details'))
    details.open = open.get(placeOf(root, details)) ?? details.open;
  const next = focused && [...root.querySelectorAll(focused.tagName)].find((x) => placeOf(root, x) === place);
  next?.focus({ preventScroll: true });
  // Numbers have none that could be set.
  if (next && selection?.[0] !== null && selection)
    next.setSelectionRange(...selection);
}

/** A field has its JSON pointer; all else is the n-th of its name in its part of the form. */
function placeOf(root, element) {
  const where = element.closest('.field')?.dataset.where;
  if (where !== undefined)
    return `${where} ${element.tagName}`;
  const step = [...root.querySelectorAll('.step-form')].indexOf(element.closest('.step-form'));
  const part = element.closest('fieldset') ?? element.closest('.step-form') ?? root;
  const like = [...part.querySelectorAll(element.tagName)].filter((x) => nameOf(x) === nameOf(element));
  return [step, part.className, part.dataset.side, element.tagName, nameOf(element), like.indexOf(element)].join(' ');
}

function nameOf(element) {
  if (element.tagName === 'BUTTON')
    return element.getAttribute('aria-label') ?? element.textContent;
  return element.closest('details')?.className ?? '';
}
