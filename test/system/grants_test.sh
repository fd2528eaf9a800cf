# What skills that are processes may: nothing beyond an ordinary program's due but
# what their node's configuration grants.

# show_identity EDIT: the skill says who it is; its descriptor is edited by jq.
show_identity() {
  mv "$skills/echo/bin/echo" "$skills/echo/bin/real"
  cat > "$skills/echo/bin/echo" << SCRIPT
#!/bin/sh
grep -E '^(Uid|Gid|CapEff|CapBnd|CapAmb|NoNewPrivs):' /proc/self/status | tr '\t' ' '
echo "home \$HOME"
exec "$skills/echo/bin/real"
SCRIPT
  chmod +x "$skills/echo/bin/echo"
  jq "$1" "$skills/echo/skill.json" > "$scratch/skill.json"
  cp "$scratch/skill.json" "$skills/echo/skill.json"
}

start_with() {
  start_node head --coordinator --cell line --interface lo "$@"
}

# run_echo: deploys the skill; its log is in $scratch/log.txt once it runs.
run_echo() {
  echo_task t > "$scratch/t.json"
  chmod -R a+rwX "$scratch/data"
  to head request "$scratch/t.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  to head logs "$instance" > "$scratch/log.txt" || fail "no log"
}

says() {
  grep -qx "$1" "$scratch/log.txt" || fail "not '$1': $(cat "$scratch/log.txt")"
}

# Five bits of root's: its way around permissions of files.
test_a_process_of_root_keeps_its_way_to_files_and_nothing_else() {
  show_identity .
  start_with
  grep -q "warning this node runs as root" "$scratch/head.log" || fail "no warning"
  run_echo
  says "Uid: 0 0 0 0"
  says "CapEff: 000000000000001f"
  says "CapBnd: 000000000000001f"
  says "NoNewPrivs: 1"
}

test_a_process_is_the_user_that_is_granted_to_its_skill() {
  show_identity .
  chmod 0755 "$scratch"
  start_with --grant echo=user:nobody
  run_echo
  # It runs, so it has reached the node's socket.
  says "Uid: 65534 65534 65534 65534"
  says "CapEff: 0000000000000000"
  says "home $(getent passwd nobody | cut -d: -f6)"
  expect "whose folder of instances it is" "$(stat -c %u "$scratch/head/instances")" 0
  terminate_task
  expect "what is left" "$(pgrep -u nobody -f "$skills" | wc -l)" 0
}

terminate_task() {
  jq -n '{type: "task_termination", task: "t"}' | to head request > "$scratch/end.json" \
    || fail "$(cat "$scratch/end.json")"
}

test_a_process_has_the_capabilities_that_are_granted() {
  show_identity '.models[].deployments[] += {capabilities: ["NET_RAW"]}'
  start_with
  echo_task t > "$scratch/t.json"
  to head request "$scratch/t.json" > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" no_feasible_allocation
  "$ROSCELL" skill check --to "$scratch/head/node.sock" "$skills/echo" > "$scratch/said" 2>&1 \
    && fail "it is content"
  grep -qF "skill 'echo' wants capability NET_RAW, which node 'head' does not grant \
it: grant = echo=capability:NET_RAW" "$scratch/said" || fail "$(cat "$scratch/said")"
  stop_node head
  chmod 0755 "$scratch"
  start_with --grant echo=capability:NET_RAW,user:nobody
  "$ROSCELL" skill check --to "$scratch/head/node.sock" "$skills/echo" > "$scratch/said" 2>&1 \
    || fail "$(cat "$scratch/said")"
  run_echo
  says "CapEff: 0000000000002000"
  says "CapBnd: 0000000000002000"
  says "CapAmb: 0000000000002000"
}

test_a_grant_that_cannot_be_meant_is_told_with_its_line() {
  local grant
  for grant in echo=user:nobody-of-that-name echo=capability:FLY echo=scheduling:fifo:100; do
    printf 'interface = lo\ngrant = %s\n' "$grant" > "$scratch/node.conf"
    timeout "$deadline_s" "$ROSCELL" node --config "$scratch/node.conf" --data-dir "$scratch/x" \
      2> "$scratch/said" && fail "it runs with $grant"
    grep -q "$scratch/node.conf:2: --grant: " "$scratch/said" \
      || fail "$(cat "$scratch/said")"
  done
}
