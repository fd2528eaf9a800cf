// The page's only entry. A part that does not come, because the node is being
// restarted, must not leave a page that waits for ever.
const AGAIN_MS = 3000;

import('./main.js').catch((trouble) => {
  console.error(trouble);
  document.getElementById('room').textContent = 'A part of the page did not come. Loading it again …';
  setTimeout(() => location.reload(), AGAIN_MS);
});
