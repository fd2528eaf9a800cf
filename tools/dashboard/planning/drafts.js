// The task that somebody is writing: it stays while they look into other pages.
let draft = null;
let notes = [];

/** `words` are sentences about where it comes from, if it was not written here. */
export function keepDraft(document, words = notes) {
  draft = document;
  notes = words;
}

export function keptDraft() {
  return draft;
}

export function draftNotes() {
  return notes;
}
