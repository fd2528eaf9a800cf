# Secrets of nodes, for whatever runtime their instances are of.

# Values that stand nowhere else on this machine.
key_value="key-$BASHPID-$RANDOM$RANDOM"
pass_value="pass-$BASHPID-$RANDOM$RANDOM"

# give NODE NAME [OPTION...]: standard input becomes a secret of that node.
give() {
  "$ROSCELL" secret set --to "$scratch/$1/node.sock" "${@:2}" 2>> "$scratch/said" \
    || fail "not set: $(tail -n 2 "$scratch/said")"
}

# forget NODE NAME...
forget() {
  "$ROSCELL" secret remove --to "$scratch/$1/node.sock" "${@:2}" 2>> "$scratch/said" \
    || fail "not removed: $(tail -n 2 "$scratch/said")"
}

secrets_of() {
  "$ROSCELL" secret list --to "$scratch/$1/node.sock" -o json
}

# secret_task TASK [NODE]: the echo skill with a secret in a file and one in a
# variable, started again soon.
secret_task() {
  echo_task "$@" | jq '.pipeline[0] += {secrets: ["key"],
    secret_env: {PASSWORD: "pass"},
    restart: {policy: "always", delay_s: 0.2, max_delay_s: 1}}'
}

# run_with_secrets TASK [NODE]: its instance is in $instance.
run_with_secrets() {
  secret_task "$@" > "$scratch/$1.json"
  to head request "$scratch/$1.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
}

terminate() {
  jq -n --arg task "$1" '{type: "task_termination", task: $task}' \
    | to head request > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
}

# not_in WHAT FILE: neither value is there, nor as it travels.
not_in() {
  local value
  for value in "$key_value" "$pass_value"; do
    ! grep -qF "$value" "$2" || fail "$1 has a value"
    ! grep -qF "$(printf %s "$value" | base64 -w0)" "$2" || fail "$1 has a value in base64"
  done
}

# nobody_has_them NODE: the values are in no answer, event, log, record or command
# line; in the data directory they are in its folder secrets only.
nobody_has_them() {
  local path name
  for path in /v1/node?actors=1 /v1/cell /v1/tasks /v1/instances /v1/secrets \
    /v1/requests "/v1/events?since=0&follow=0" "/v1/events?past=1" /metrics \
    "/v1/instances/$instance/logs"; do
    get "$1" "$path" > "$scratch/answer" || fail "no answer of $path"
    not_in "$path" "$scratch/answer"
  done
  for name in $(get "$1" "/v1/node?actors=1" | jq -r '.actors[].name' | sort -u); do
    get "$1" "/v1/actors/$name" > "$scratch/answer"
    not_in "the actor $name" "$scratch/answer"
  done
  not_in "the node's log" "$scratch/$1.log"
  cat /proc/[0-9]*/cmdline > "$scratch/answer" 2> /dev/null
  not_in "a command line" "$scratch/answer"
  for path in "$key_value" "$pass_value" "$(printf %s "$key_value" | base64 -w0)" \
    "$(printf %s "$pass_value" | base64 -w0)"; do
    grep -rlF "$path" "$scratch/$1" 2> /dev/null
  done | sort -u > "$scratch/holders"
  expect "files that have a value" "$(cat "$scratch/holders")" \
    "$(printf '%s\n' "$scratch/$1/secrets/key.secret" "$scratch/$1/secrets/pass.secret")"
}
