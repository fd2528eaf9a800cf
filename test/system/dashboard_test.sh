# The dashboard in a real browser, against a real cell and under load, and
# `roscell top` in a real terminal.

test_people_see_and_do_what_they_came_for() {
  local tool
  for tool in chromium chromedriver; do
    command -v $tool > /dev/null || skip "there is no $tool"
  done
  /usr/bin/python3 -c 'import selenium' 2> /dev/null || skip "there is no Selenium"
  test/dashboard/run.sh "$ROSCELL_BUILD" > "$scratch/said" 2>&1 \
    || fail "$(tail -n 30 "$scratch/said")"
}

# page NAME PATH: what that node's Unix socket shows a browser.
page() {
  curl -sS -i --max-time "$deadline_s" \
    --unix-socket "$scratch/$1/node.sock" "http://node$2"
}

test_a_coordinator_shows_it_to_those_who_may_open_its_socket_only() {
  local address
  start_node head --coordinator --cell line --interface lo
  page head /dashboard/ > "$scratch/said"
  has_line 'Content-Security-Policy: default-src' "$scratch/said" \
    || fail "$(head -n 20 "$scratch/said")"
  address=$(get head /v1/cell | jq -r .address)
  expect "over TCP" "$(curl -s -o /dev/null -w '%{http_code}' \
    -H "Authorization: Bearer $(cat "$scratch/head/token")" \
    "http://$address/dashboard/")" 404
  start_node arm --interface lo --join "$(discovery_of head)"
  page arm /dashboard/ > "$scratch/said"
  has_line '404 Not Found' "$scratch/said" || fail "$(head -n 3 "$scratch/said")"
}

. test/system/scenes/terminal.sh

# open_top WIDTH HEIGHT [NODE]: `roscell top` of that node, else `head`, run by a
# shell.
open_top() {
  open_terminal "$1" "$2"
  run_here "$ROSCELL top --to $scratch/${3:-head}/node.sock"
  await_screen ' live'
}

start_line() {
  start_node head --coordinator --cell line --interface lo --label place=head
  start_node arm --interface lo --join "$(discovery_of head)" --label place=arm
  await_joined head arm
}

end_top() {
  type_keys q
  ended_with 0
}

test_top_shows_nodes_and_tasks_on_80_columns_and_grows() {
  start_line
  echo_task t arm | to head request > /dev/null
  open_top 80 24
  await_screen 'all is well'
  await_screen '^.arm +active +[█▒·]+ .*[0-9]%'
  await_screen '^.t +running +1/1 '
  await_screen '^.t +say +arm +running '
  on_screen > "$scratch/small"
  has_line 'ADDRESS' "$scratch/small" && fail "$(cat "$scratch/small")"
  tmux resize-window -t it -x 160 -y 40
  await_screen 'ADDRESS'
  tmux resize-window -t it -x 50 -y 10
  await_no 'ADDRESS'
  await_screen '^.t '
  tmux resize-window -t it -x 80 -y 24
  # A new task comes by its events, without a key.
  echo_task u head | to head request > /dev/null
  await_screen '^.u +running +1/1 '
  to head stop u > /dev/null 2>&1
  await_no '^.u '
  end_top
}

test_top_says_which_node_is_lost_and_what_that_means() {
  start_line
  echo_task t arm | to head request > /dev/null
  open_top 100 24
  await_screen '^.t +running'
  stop_node arm KILL
  await_screen '^\(1 of [0-9]\) node arm lost|^node arm lost'
  await_screen '^.arm +lost'
  await_screen '^.t +degraded +0/1'
  await_screen '^.t +say +arm +unknown'
  start_node arm --interface lo --join "$(discovery_of head)" --label place=arm
  await_screen '^.arm +active'
  await_screen '^.t +running +1/1'
  await_screen 'all is well'
  end_top
}

test_top_says_that_its_node_is_away_and_finds_it_again() {
  start_line
  open_top 80 24
  stop_node head KILL
  await_screen 'NO ANSWER'
  await_screen 'looking again'
  # What was known stays to be read.
  await_screen '^.arm '
  start_node head --coordinator --cell line --interface lo --label place=head
  await_screen ' live'
  await_screen '^.head +active'
  end_top
}

test_top_takes_keys_while_its_node_hangs() {
  start_line
  open_top 80 24
  await_screen 'all is well'
  kill -STOP "${pid[head]}"
  type_keys Tab
  await_screen '^>TASK'
  end_top
}

test_top_of_a_member_shows_it_and_names_the_coordinator() {
  start_line
  open_top 80 24 arm
  await_screen "this node only; .* --to $(get head /v1/cell | jq -r .address)"
  await_screen '^>arm +active'
  end_top
}

test_top_filters_sorts_and_tells_more_of_what_is_selected() {
  start_line
  echo_task alpha arm | to head request > /dev/null
  echo_task beta head | to head request > /dev/null
  open_top 100 30
  await_screen '^.beta +running'
  type_keys / ALP Enter
  await_no '^.beta'
  await_screen '^.alpha +running'
  type_keys Escape
  await_screen '^.beta +running'
  type_keys Tab S
  await_screen '^>TASK 2 v'
  on_screen | grep -E '^.(alpha|beta) +running +1/1' > "$scratch/order"
  expect "sorted from the end" "$(head -c 5 "$scratch/order")" '>beta'
  type_keys Enter
  await_screen '^ task beta'
  await_screen 'Kind: +task'
  type_keys Escape Tab Home l
  await_screen '^ log of alpha-say-'
  type_keys q e
  await_screen 'task_accepted'
  type_keys '?'
  await_screen 'reserved by instances'
  type_keys q
  await_screen '^.alpha +running'
  type_keys BTab l
  await_screen 'only instances have a log'
  end_top
}

test_top_leaves_the_terminal_as_it_was() {
  start_line
  open_top 80 24
  type_keys C-z
  await_screen 'Stopped'
  expect "the other screen" "$(tmux display-message -p -t it '#{alternate_on}')" 0
  type_keys fg Enter
  await_screen '^.arm +active'
  signal_program TERM
  ended_with 0
  local way
  for way in SEGV ABRT; do
    run_here "(ulimit -c 0; exec $ROSCELL top --to $scratch/head/node.sock)"
    await_screen '^.arm +active'
    signal_program $way
    ended_with "[0-9]*"
  done
  run_here "$ROSCELL top --to $scratch/head/node.sock"
  await_screen '^.arm +active'
  type_keys C-c
  ended_with 0
}

test_top_needs_a_terminal_but_a_poor_one_will_do() {
  local locale=C code=0
  "$ROSCELL" top < /dev/null > "$scratch/said" 2>&1 || code=$?
  expect "exit code" $code 2
  has_line 'roscell tasks' "$scratch/said" || fail "$(cat "$scratch/said")"
  "$ROSCELL" top --sort nothing > "$scratch/said" 2>&1 || code=$?
  expect "exit code" $code 2
  has_line 'the columns are NODE, STATE' "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  start_line
  open_terminal 80 24
  run_here "TERM=dumb $ROSCELL top --to $scratch/head/node.sock"
  await_screen "kind 'dumb' cannot be a full screen"
  ended_with 2
  run_here "TERM=vt100 NO_COLOR=1 $ROSCELL top --to $scratch/head/node.sock"
  await_screen '^.arm +active +[#+.]+ .*[0-9]%'
  type_keys q
  await_screen '^prompt>$'
}
