# A real terminal that scripts type into and read: a shell in tmux, whose screen
# is looked at whenever something was written to it.

# open_terminal WIDTH HEIGHT: a shell with job control; its process is $shell.
open_terminal() {
  command -v tmux > /dev/null || skip "there is no tmux"
  export TMUX_TMPDIR=$scratch
  mkfifo "$scratch/written"
  exec {written}<> "$scratch/written"
  tmux -u -f /dev/null new-session -d -x "$1" -y "$2" -s it \
    "exec env LC_ALL=${locale:-C.UTF-8} PS1='prompt> ' bash --norc --noprofile -i"
  shell=$(tmux display-message -p -t it '#{pane_pid}')
  echo "$shell" >> "$scratch/pids"
  tmux pipe-pane -t it "cat > '$scratch/written'"
  await_screen 'prompt>'
}

# type_keys KEY...: as `tmux send-keys` takes them.
type_keys() {
  tmux send-keys -t it "$@"
}

on_screen() {
  tmux capture-pane -p -t it
}

# await_screen PATTERN: waits until a line of the screen matches, and looks again
# whenever something was written.
await_screen() {
  local end=$((SECONDS + deadline_s))
  until on_screen | has_line -E "$1"; do
    await_written $end || fail "there is no '$1' on the screen: $(on_screen)"
  done
}

# await_no PATTERN: the same until no line matches.
await_no() {
  local end=$((SECONDS + deadline_s))
  while on_screen | has_line -E "$1"; do
    await_written $end || fail "'$1' stays on the screen: $(on_screen)"
  done
}

# await_written END: false at that second.
await_written() {
  [[ $SECONDS -lt $1 ]] || return 1
  timeout $(($1 - SECONDS)) dd bs=65536 count=1 status=none <&"$written" \
    > /dev/null
}

# signal_program SIGNAL: to what the shell runs.
signal_program() {
  kill "-$1" "$(pgrep -P "$shell")"
}

# run_here COMMAND: typed into the shell, which remembers the terminal's modes
# before.
run_here() {
  type_keys "stty -a > $scratch/modes; clear" Enter
  await_screen '^prompt>$'
  type_keys "$1" Enter
}

# ended_with CODE: the shell is back, the program has ended so, and the terminal
# is as it was: its modes, the screen and the cursor.
ended_with() {
  await_screen '^prompt>$'
  type_keys "echo code \$?; stty -a > $scratch/modes.after; echo done" Enter
  await_screen '^done$'
  on_screen | has_line "^code $1\$" || fail "$(on_screen)"
  expect "modes of the terminal" "$(cat "$scratch/modes.after")" \
    "$(cat "$scratch/modes")"
  expect "the other screen, the cursor" \
    "$(tmux display-message -p -t it '#{alternate_on} #{cursor_flag}')" '0 1'
}
