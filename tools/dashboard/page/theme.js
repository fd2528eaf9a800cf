// Light and dark: as the system says, or as somebody has chosen here.
const KEY = 'roscell-theme';
const CHOICES = ['system', 'light', 'dark'];

export function setUpTheme(button) {
  let choice = stored();
  const show = () => {
    document.documentElement.dataset.theme = choice;
    button.textContent = `Theme: ${choice}`;
  };
  const next = () => {
    choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
    keep(choice);
    show();
    return choice;
  };
  button.addEventListener('click', next);
  show();
  return next;
}

// A browser may forbid to keep anything; then the choice lasts as long as the page.
function stored() {
  try {
    return CHOICES.find((x) => x === localStorage.getItem(KEY)) ?? 'system';
  } catch {
    return 'system';
  }
}

function keep(choice) {
  try {
    localStorage.setItem(KEY, choice);
  } catch {
    // Nothing is lost but the choice.
  }
}
