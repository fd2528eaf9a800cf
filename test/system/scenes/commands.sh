# Commands that run beside instances, for whatever runtime they are of.

# How long the longest of these commands would take: no other test has it.
long_s=$((100000 + BASHPID))

# beside [OPTION...] -- COMMAND...: beside $instance, asked of the node $asked.
asked=head
beside() {
  to "$asked" exec "$@"
}

# say COMMAND...: what it says on its standard output, without any input.
say() {
  beside -n "$instance" -- "$@"
}

# begin_long: a command that takes long, with a child of a session of
# its own; its client is $client, its processes are $members.
begin_long() {
  rm -f "$scratch/long.out"
  # No function: a signal to the client is to reach it.
  "$ROSCELL" exec --to "$scratch/$asked/node.sock" -n "$instance" -- sh -c \
    "setsid sleep $long_s & echo ready; exec sleep $long_s" \
    > "$scratch/long.out" 2> "$scratch/long.err" < /dev/null &
  client=$!
  echo "$client" >> "$scratch/pids"
  timeout "$deadline_s" grep -m 1 ready > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/long.out" 2> /dev/null) \
    || fail "it does not begin: $(cat "$scratch/long.err")"
  mapfile -t members < <(pgrep -f "sleep $long_s")
  # Its shim, its shell, and what these have started.
  [[ ${#members[@]} -ge 3 ]] || fail "$(pgrep -a -f "sleep $long_s")"
}

# long_ends CODE [PATTERN]: its client ends so, and says so, and nothing of it is
# left.
long_ends() {
  local code=0 member
  timeout "$deadline_s" tail --pid="$client" -f /dev/null \
    || fail "the client goes on"
  wait "$client" || code=$?
  expect "the client's exit code" "$code" "$1"
  [[ -z ${2:-} ]] || has_line -E "$2" "$scratch/long.err" \
    || fail "$(cat "$scratch/long.err")"
  for member in "${members[@]}"; do
    timeout "$deadline_s" tail --pid="$member" -f /dev/null \
      || fail "it is left: $(pgrep -a -f "sleep $long_s")"
  done
  [[ -z $(pgrep -f "sleep $long_s") ]] \
    || fail "it is left: $(pgrep -a -f "sleep $long_s")"
}

# goes_on: the instance is the one that it was, and does its work.
goes_on() {
  local row
  lines_come "$1" "$2"
  row=$(get "$asked" "/v1/instances/$instance" | jq -c '.instances[0]')
  expect "its state and restarts" \
    "$(jq -r '"\(.state) \(.restarts // 0)"' <<< "$row")" "running 0"
}

commands_work() {
  local code=0
  expect "the outputs apart" \
    "$(beside -n "$instance" -- sh -c 'echo out; echo err >&2; exit 3' \
      2> "$scratch/err"; echo "$?")" $'out\n3'
  expect "its standard error" "$(cat "$scratch/err")" err
  expect "its input" "$(printf 'a\0b' | beside -i "$instance" -- od -An -tx1)" \
    " 61 00 62"
  expect "words with blanks" "$(say printf '%s.' 'a  b' '' "c'd")" "a  b..c'd."
  say sh -c 'kill -9 $$' || code=$?
  expect "the code of a signal" "$code" 137
  code=0
  say no-such-program 2> "$scratch/err" || code=$?
  expect "the code of a program that is not there" "$code" 127
  has_line "roscell exec: cannot run 'no-such-program'" "$scratch/err" \
    || fail "$(cat "$scratch/err")"
}

# 50 MiB there and back.
bytes_come_back() {
  head -c $((50 * 1024 * 1024)) /dev/urandom > "$scratch/bytes"
  beside "$instance" -- cat < "$scratch/bytes" | sha256sum > "$scratch/sum" \
    || fail "it did not work"
  expect "the hash" "$(cut -d' ' -f1 "$scratch/sum")" \
    "$(sha256sum "$scratch/bytes" | cut -d' ' -f1)"
}

# It is told who has run what, but not with which arguments.
commands_are_told() {
  local begun ended session
  say dash -c 'exit 4'
  begun=$(await head ".event == \"exec_begun\" and .data.program == \"dash\"
    and .subject == \"$instance\"")
  session=$(jq -r .data.session <<< "$begun")
  ended=$(await head ".event == \"exec_ended\"
    and .data.session == \"$session\"")
  expect "who" "$(jq -r .data.from <<< "$begun")" root
  expect "how it ended" "$(jq -r .data.exit_code <<< "$ended")" 4
  "$ROSCELL" events --to "$scratch/head/node.sock" --no-follow -o json \
    > "$scratch/events" 2>&1
  ! has_line 'exit 4' "$scratch/events" || fail "its arguments are told"
}

# a_terminal_serves_a_command: a shell beside $instance knows the size of its
# terminal, hears when that changes, gets Ctrl-C, and ends with its exit code.
a_terminal_serves_a_command() {
  open_terminal 80 24
  run_here "$ROSCELL exec --to $scratch/head/node.sock $instance -- bash --norc"
  await_screen '^bash.*[$#]$'
  type_keys 'tty -s && stty size' Enter
  await_screen '^24 80$'
  type_keys "bash -c \"trap 'clear; stty size' WINCH; echo set; \
while sleep 0.1; do :; done\"" Enter
  await_screen '^set$'
  tmux resize-window -t it -x 100 -y 30
  await_screen '^30 100$'
  tmux resize-window -t it -x 80 -y 24
  await_screen '^24 80$'
  type_keys C-c "sleep $long_s" Enter
  await_screen "sleep $long_s"
  type_keys C-c 'echo it is $?' Enter
  await_screen '^it is 130$'
  type_keys 'exit 5' Enter
  ended_with 5
}
