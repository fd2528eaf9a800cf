# What was said yesterday: events outlive their node, whatever ends it, and say who has
# asked for what.

start_alone() {
  start_node head --coordinator --cell line --interface lo "$@"
}

# past ARGUMENT...: what `events` tells of what was, as JSON lines.
past() {
  to head events --no-follow -o json "$@"
}

test_what_was_said_before_a_restart_is_told_after_it() {
  local before
  start_alone
  echo_task hello | to head request - > /dev/null
  to head stop hello > /dev/null
  before=$(get head '/v1/events?since=0&follow=0' | grep -c '^id:')
  stop_node head
  start_alone
  past --since 1h > "$scratch/past.json"
  expect "who has asked for what" "$(jq -r 'select(.event == "request_received")
    | [.subject, .data.request, .data.from] | join(" ")' "$scratch/past.json")" \
    "hello task_request $(id -u | sed 's/^0$/root/; t; s/^/user /')
hello task_termination $(id -u | sed 's/^0$/root/; t; s/^/user /')"
  expect "starts of the node" \
    "$(jq -r 'select(.event == "node_started") | .event' "$scratch/past.json" \
      | wc -l)" 2
  expect "its end" "$(jq -r 'select(.event == "node_stopping") | .event' \
    "$scratch/past.json")" node_stopping
  [[ $(wc -l < "$scratch/past.json") -gt $before ]] \
    || fail "$before events before, now $(wc -l < "$scratch/past.json")"
  expect "numbers without a gap" \
    "$(jq -s 'map(.sequence) | . == [range(1; length + 1)]' "$scratch/past.json")" true
  expect "the newest" "$(past -n 3 | jq -s 'map(.sequence)' -c)" \
    "$(jq -s 'map(.sequence)[-3:]' -c "$scratch/past.json")"
  expect "after a number" "$(past --since 4 | head -n 1 | jq .sequence)" 5
  expect "of the future" "$(past --since "$(date -d '1 hour' '+%F %H:%M')")" ''
  to head events --since 1h --no-follow > "$scratch/table"
  grep -q 'request_received.*hello' "$scratch/table" || fail "$(cat "$scratch/table")"
}

test_no_number_is_given_twice_though_the_node_is_killed() {
  local last
  start_alone
  stop_node head
  start_alone
  echo_task hello | to head request - > /dev/null
  # What the followers have heard has not reached the disk yet.
  last=$(get head '/v1/events?since=0&follow=0' | sed -n 's/^id: //p' | tail -n 1)
  stop_node head KILL
  start_alone
  past --since start > "$scratch/past.json"
  expect "the first run is there" \
    "$(jq -r 'select(.event == "node_stopping") | .event' "$scratch/past.json")" \
    node_stopping
  expect "numbers grow" "$(jq -s 'map(.sequence) | . == unique' "$scratch/past.json")" true
  jq -e -s --argjson last "$last" '[.[] | select(.event == "node_started")][-1].sequence
    > $last' "$scratch/past.json" > /dev/null || fail "given twice: $last"
}

test_what_is_no_moment_is_refused_before_the_node_is_asked() {
  "$ROSCELL" events --since yesterday --to /nowhere > "$scratch/out" 2>&1
  expect "exit code" $? 2
  grep -q "'yesterday' is neither" "$scratch/out" || fail "$(cat "$scratch/out")"
}

# fill_disk FOLDER: of a disk of its own not a byte is left.
fill_disk() {
  mountpoint -q "$1" || fail "$1 is no disk of its own"
  dd if=/dev/zero of="$1/rest" bs=4k 2> /dev/null
  expect "room" "$(df --output=avail "$1" | tail -n 1 | tr -d ' ')" 0
}

test_a_disk_that_is_full_takes_the_history_first() {
  [[ $(id -u) -eq 0 ]] || skip "a disk of its own needs root"
  mkdir -p "$scratch/head"
  mount -t tmpfs -o size=12m,mode=0700 none "$scratch/head" || skip "it may not mount"
  start_alone
  stop_node head
  # As much as a week has.
  head -c 9000000 /dev/zero | tr '\0' 'x' > "$scratch/head/history/events.1"
  touch -d '2 days ago' "$scratch/head/history/events.1"
  fill_disk "$scratch/head"
  start_alone
  echo_task hello | to head request - > "$scratch/reply" || fail "$(cat "$scratch/reply")"
  expect "the task" "$(get head /v1/tasks/hello | jq -r '.tasks[0].state')" running
  [[ $(stat -c %s "$scratch/head/history/events.1") -lt 1000000 ]] \
    || fail "the history has not given way"
  expect "node_started" "$(get head '/v1/events?since=0&follow=0' \
    | grep -c '^event: node_started')" 1
  to head stop hello > /dev/null
  stop_node head
  umount -l "$scratch/head"
}

test_a_history_that_cannot_be_read_stops_nobody() {
  start_alone
  stop_node head
  rm -r "$scratch/head/history"
  echo nonsense > "$scratch/head/history"
  start_alone
  echo_task hello | to head request - > "$scratch/reply" || fail "$(cat "$scratch/reply")"
  await head '.event == "history_failed"' > "$scratch/failed.json"
  grep -q "head/history" "$scratch/failed.json" || fail "$(cat "$scratch/failed.json")"
  expect "the past" "$(past --since start | jq -r 'select(.event == "task_running") | .event')" \
    "$(get head '/v1/events?since=0&follow=0' | sed -n 's/^event: \(task_running\)/\1/p')"
}
