// The task that somebody is writing: it stays while they look into other rooms.
let draft = null;

export function keepDraft(document) {
  draft = document;
}

export function keptDraft() {
  return draft;
}
