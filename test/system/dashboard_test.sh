# How people look at a cell: the dashboard in a real browser, against a real cell
# and under load; `roscell top` and the shell at a terminal.

slow=(test_people_see_and_do_what_they_came_for test_a_page_sees_faults_that_no_real_cell_has_at_will)
alone=(test_a_page_of_a_large_cell_stays_fluent)

# in_a_browser WHAT: test/dashboard/run.sh does that.
in_a_browser() {
  local tool
  for tool in chromium chromedriver; do
    command -v $tool > /dev/null || skip "there is no $tool"
  done
  /usr/bin/python3 -c 'import selenium' 2> /dev/null || skip "there is no Selenium"
  test/dashboard/run.sh "$ROSCELL_BUILD" "$1" > "$scratch/said" 2>&1 \
    || fail "$(tail -n 30 "$scratch/said")"
  cat "$scratch/said"
}

test_people_see_and_do_what_they_came_for() {
  in_a_browser scene
}

test_a_page_sees_faults_that_no_real_cell_has_at_will() {
  in_a_browser faults
}

test_a_page_of_a_large_cell_stays_fluent() {
  in_a_browser load
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

# fake_browser: an `xdg-open` that tells what it was given and how, once.
fake_browser() {
  mkdir "$scratch/bin" "$scratch/home"
  mkfifo "$scratch/opened"
  cat > "$scratch/bin/xdg-open" << FAKE
#!/bin/bash
{
  echo "\$*"
  stat -c %a "\$1"
  cat "\$1"
  grep SigBlk: /proc/self/status
  ps -o sid= \$\$
} > "$scratch/opened"
FAKE
  chmod +x "$scratch/bin/xdg-open"
}

test_a_browser_is_led_to_the_dashboard_by_a_file_that_only_its_user_reads() {
  local address file mode page blocked session dashboard address_fd opened_fd
  start_node head --coordinator --cell line --interface lo
  fake_browser
  mkfifo "$scratch/address"
  exec {address_fd}<> "$scratch/address" {opened_fd}<> "$scratch/opened"
  HOME=$scratch/home DISPLAY=:7 PATH=$scratch/bin:$PATH "$ROSCELL" dashboard \
    --to "$scratch/head/node.sock" > "$scratch/address" 2> "$scratch/said" &
  dashboard=$!
  echo "$dashboard" >> "$scratch/pids"
  read -r -t "$deadline_s" address <&"$address_fd" || fail "no address is said"
  { read -r -t "$deadline_s" file && read -r mode && read -r page \
      && read -r _ blocked && read -r session; } <&"$opened_fd" \
    || fail "no browser is started"
  [[ $file == "$scratch"/home/roscell-dashboard-*.html ]] || fail "it gets $file"
  expect "mode of the file" "$mode" 600
  [[ $page == *"url=$address\""* ]] || fail "it leads elsewhere: $page"
  expect "signals that the browser cannot get" "$blocked" 0000000000000000
  [[ $session -ne $(ps -o sid= "$dashboard") ]] || fail "Ctrl-C ends it, too"
  curl -sSL --max-time "$deadline_s" -c "$scratch/cookies" -b "$scratch/cookies" \
    "$address" | has_line '<html' || fail "there is no page"
  # Whoever finds the link later has nothing of it.
  expect "the link once more" "$(curl -s -o /dev/null -w '%{http_code}' "$address")" 401
  kill -TERM "$dashboard"
  wait "$dashboard" || fail "it ends with $?"
  expect "what is left" "$(ls "$scratch/home")" ''
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
  await_screen '^.arm .*active .*[█▒·]+ +[0-9.]+/[0-9]'
  await_screen '^.t +running .* 1/1 '
  await_screen '^.t-say-[0-9a-f]+ .*arm +running '
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
  await_screen '^.u +running .* 1/1 '
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
  await_screen '^.arm .*lost'
  await_screen '^.t +degraded .* 0/1'
  await_screen '^.t-say-[0-9a-f]+ .*arm +unknown'
  start_node arm --interface lo --join "$(discovery_of head)" --label place=arm
  await_screen '^.arm .*active'
  await_screen '^.t +running .* 1/1'
  await_screen 'all is well'
  end_top
}

test_top_says_that_its_node_is_away_and_finds_it_again() {
  start_line
  open_top 80 24
  await_screen '^.arm .*active'
  stop_node head KILL
  await_screen 'NO ANSWER'
  await_screen 'looking again'
  # What was known stays to be read.
  await_screen '^.arm '
  start_node head --coordinator --cell line --interface lo --label place=head
  await_screen ' live'
  await_screen '^.head .*active'
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
  await_screen '^>arm .*active'
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
  on_screen | grep -E '^.(alpha|beta) +running .* 1/1' > "$scratch/order"
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
  await_screen '^.arm .*active'
  signal_program TERM
  ended_with 0
  local way
  for way in SEGV ABRT; do
    run_here "(ulimit -c 0; exec $ROSCELL top --to $scratch/head/node.sock)"
    await_screen '^.arm .*active'
    signal_program $way
    ended_with "[0-9]*"
  done
  run_here "$ROSCELL top --to $scratch/head/node.sock"
  await_screen '^.arm .*active'
  type_keys C-c
  ended_with 0
}

test_top_within_a_shell_is_not_stopped() {
  start_line
  open_terminal 80 24
  run_here "$ROSCELL shell --to $scratch/head/node.sock"
  await_screen '^head@line>$'
  type_keys top Enter
  await_screen '^>arm .*active'
  type_keys C-z Tab
  await_screen '^>TASK'
  type_keys q
  await_screen '^head@line>$'
  type_keys C-d
  ended_with 0
}

test_a_shell_that_is_told_to_end_leaves_the_terminal_as_it_was() {
  start_node head --coordinator --cell line --interface lo
  open_terminal 80 24
  local way
  for way in TERM HUP QUIT; do
    run_here "$ROSCELL shell --to $scratch/head/node.sock"
    await_screen '^head@line>$'
    type_keys 'stop nothing'
    await_screen '^head@line> stop nothing$'
    signal_program $way
    ended_with 0
    on_screen | has_line 'roscell:' && fail "a line that was begun is done"
  done
  run_here "$ROSCELL shell --to $scratch/head/node.sock"
  await_screen '^head@line>$'
  type_keys 'events --since 0' Enter
  await_screen 'node_started'
  # Ctrl-\ ends the command only, SIGTERM the shell with it.
  type_keys 'C-\'
  await_screen '^head@line>$'
  tmux send-keys -t it -R \; clear-history -t it
  type_keys 'events --since 0' Enter
  await_screen 'node_started'
  signal_program TERM
  ended_with 0
}

test_top_needs_a_terminal_but_a_poor_one_will_do() {
  local locale=C code=0
  "$ROSCELL" top < /dev/null > "$scratch/said" 2>&1 || code=$?
  expect "exit code" $code 2
  has_line 'roscell tasks' "$scratch/said" || fail "$(cat "$scratch/said")"
  "$ROSCELL" top --sort nothing > "$scratch/said" 2>&1 || code=$?
  expect "exit code" $code 2
  has_line 'the columns are NODE, ROLE, STATE' "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  # As earlier versions called them: all that is missing is the terminal.
  local earlier
  for earlier in drops -id instance-of; do
    "$ROSCELL" top "--sort=$earlier" < /dev/null > "$scratch/said" 2>&1
    has_line 'needs a terminal' "$scratch/said" || fail "$earlier: $(cat "$scratch/said")"
  done
  start_line
  open_terminal 80 24
  run_here "TERM=dumb $ROSCELL top --to $scratch/head/node.sock"
  await_screen "kind 'dumb' cannot be a full screen"
  ended_with 2
  run_here "TERM=vt100 NO_COLOR=1 $ROSCELL top --to $scratch/head/node.sock"
  await_screen '^.arm .*active .*[#+.]+ +[0-9.]+/[0-9]'
  type_keys q
  await_screen '^prompt>$'
}


# open_shell NODE: the shell of that node at a terminal of its own. What is
# typed goes into $keyboard, what it shows comes from $screen.
open_shell() {
  mkfifo "$scratch/keyboard" "$scratch/screen"
  exec {keyboard}<> "$scratch/keyboard" {screen}<> "$scratch/screen"
  TERM=xterm XDG_STATE_HOME=$scratch/state script -qefc \
    "$ROSCELL shell --to $scratch/$1/node.sock" /dev/null \
    < "$scratch/keyboard" > "$scratch/screen" 2> "$scratch/script.err" &
  shell_pid=$!
  echo "$shell_pid" >> "$scratch/pids"
}

# type_in KEYS: as printf writes them: \r is Enter, \t Tab, \003 Ctrl-C.
type_in() {
  printf '%b' "$1" >&"$keyboard"
}

# sees TEXT...: reads what the terminal gets until each of them has come.
sees() {
  local text shown x end=$((SECONDS + deadline_s))
  for text in "$@"; do
    shown=
    until [[ $shown == *"$text" ]]; do
      # A signal, such as that of a child's end, may cut it short, too.
      if IFS= read -r -N 1 -t $((end - SECONDS)) x <&"$screen"; then
        shown+=$x
      elif ((SECONDS >= end)); then
        fail "the shell does not show '$text' but: $shown"
      fi
    done
  done
}

test_a_shell_does_a_line_and_ends_with_its_code() {
  local code=0 sock=$scratch/head/node.sock
  start_node head --coordinator --cell line --interface lo
  to head shell -c 'nodes -o json' | jq -e '.[0].name == "head"' > /dev/null \
    || fail "the nodes are not told"
  to head shell -c tree | has_line '^cell-coordinator .*[0-9]' \
    || fail "the actors are not told"
  to head shell -c '{"type": "cell_list_query"}' \
    | jq -e '.cells[0].cell == "line"' > /dev/null || fail "no JSON reply"
  to head shell -c 'tasks nope' 2> "$scratch/said" || code=$?
  expect "code of what is refused" "$code" 1
  for line in taks node "tasks 'x" 'follow'; do
    code=0
    to head shell -c "$line" 2> "$scratch/said" || code=$?
    expect "code of '$line'" "$code" 2
    has_line '^hint: \|quote' "$scratch/said" || fail "$(cat "$scratch/said")"
  done
  code=0
  to head shell -c 'tree nope' 2> "$scratch/said" || code=$?
  expect "code of a node that is not there" "$code" 1
  has_line "no node 'nope'" "$scratch/said" || fail "$(cat "$scratch/said")"
  code=0
  "$ROSCELL" shell --to "$scratch/gone.sock" -c "nodes --to $sock" \
    > /dev/null || fail "a line may name another node"
  "$ROSCELL" shell --to "$scratch/gone.sock" -c nodes 2> /dev/null || code=$?
  expect "code without a node" "$code" 3
}

test_a_completion_asks_the_node_that_the_line_names() {
  start_node head --coordinator --cell line --interface lo
  expect "what may follow" "$("$ROSCELL" completion \
    --line "roscell drain --to $scratch/head/node.sock " | cut -f 1)" head
  expect "without a node" \
    "$("$ROSCELL" completion --line "roscell drain --to $scratch/no.sock ")" ''
}

test_a_script_of_the_shell_stops_at_its_first_error() {
  local code=0
  start_node head --coordinator --cell line --interface lo
  printf '%s\n' '# what a morning begins with' 'cells --no-headers' '' \
    '{"type":' ' "cell_list_query"}' 'tasks nope' 'nodes --no-headers' \
    > "$scratch/script"
  to head shell < "$scratch/script" > "$scratch/out" 2> "$scratch/err" \
    || code=$?
  expect "code" "$code" 1
  has_line '^line  *head' "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line '"type": "cell_list"' "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line 'line 6 has failed with exit code 1' "$scratch/err" \
    || fail "$(cat "$scratch/err")"
  ! has_line '^head ' "$scratch/out" || fail "it went on"
  code=0
  to head shell --keep-going < "$scratch/script" > "$scratch/out" 2> /dev/null \
    || code=$?
  expect "code of one that goes on" "$code" 1
  has_line '^head ' "$scratch/out" || fail "it did not go on"
}

test_the_actors_of_any_node_are_shown_by_any_node() {
  start_node head --coordinator --cell line --interface lo
  start_node arm --interface lo --join "$(discovery_of head)"
  await_joined head arm
  to head shell -c "tree arm" | has_line '^arm, .* in cell line$' \
    || fail "head does not tell the actors of arm"
  to arm shell -c "tree head" > "$scratch/tree"
  grep -A 1 '^cell-coordinator ' "$scratch/tree" | has_line '^└ member ' \
    || fail "arm does not tell the actors of head: $(cat "$scratch/tree")"
  to head inspect membership --node arm | has_line 'joined' \
    || fail "head does not tell what arm's membership knows"
}

test_a_shell_at_a_terminal_completes_follows_and_asks() {
  start_node head --coordinator --cell line --interface lo
  echo_task greeting > "$scratch/greeting.json"
  to head request "$scratch/greeting.json" > /dev/null
  open_shell head
  sees 'head@line> '
  type_in 'tasks gre\t\r'
  sees 'STEP' 'say' 'head@line> '
  type_in 'follow task_*\r'
  sees 'shows task_*' 'head@line> '
  type_in 'nodes --no-hea'
  to head stop greeting > /dev/null
  sees 'task_terminated' 'head@line> ' 'nodes --no-hea'
  type_in 'ders\r'
  sees 'head ' 'head@line> '
  type_in 'events --since 0\r'
  sees 'node_started' 'task_terminated'
  type_in '\003'
  sees 'head@line> '
  type_in '{"type": "cell_list_query",\r'
  sees '... '
  type_in ' "celll": 1\r'
  sees '... '
  type_in '}\r'
  sees 'request.json:2:2: there is no member "celll" here' 'head@line> '
  type_in '{"type":\r'
  sees '... '
  type_in '\003'
  sees 'head@line> '
  type_in '\033[200~{\n\t"type": "cell_list_query"\n}\n\033[201~'
  sees '"type": "cell_list"' 'head@line> '
  type_in '\004'
  timeout "$deadline_s" tail --pid="$shell_pid" -f /dev/null \
    || fail "Ctrl-D does not end it"
  wait "$shell_pid" || fail "it ends with $?"
  expect "mode of the history" "$(stat -c %a "$scratch/state/roscell/history")" 600
  has_line '^follow task_\*$' "$scratch/state/roscell/history" \
    || fail "$(cat "$scratch/state/roscell/history")"
}

test_a_shell_of_a_member_knows_what_its_coordinator_knows() {
  start_node head --coordinator --cell line --interface lo
  start_node arm --interface lo --join "$(discovery_of head)"
  await_joined head arm
  echo_task greeting | to head request > /dev/null
  open_shell arm
  sees 'arm@line> '
  type_in 'tree he\t\r'
  sees 'cell-coordinator' 'arm@line> '
  type_in 'why gree\t\r'
  sees "task 'greeting' was placed so" 'arm@line> '
  type_in 'trace gree\t\r'
  sees 'record_intent' 'arm@line> '
}

test_the_words_of_a_shell_may_follow_the_name_of_the_program() {
  start_node head --coordinator --cell line --interface lo
  open_shell head
  sees 'head@line> '
  type_in 'roscell foll\t\r'
  sees 'shows all events' 'head@line> '
  type_in 'roscell tree\r'
  sees 'cell-coordinator' 'head@line> '
  type_in 'roscell exit\r'
  timeout "$deadline_s" tail --pid="$shell_pid" -f /dev/null \
    || fail "it does not end"
  printf '%s\n' 'roscell exit' nonsense > "$scratch/script"
  to head shell < "$scratch/script" || fail "a script does not end either"
}

test_a_shell_looks_for_a_node_that_is_lost() {
  start_node head --coordinator --cell line --interface lo
  open_shell head
  sees 'head@line> '
  stop_node head KILL
  sees 'head is lost: ' 'head (lost)> '
  type_in 'nodes\r'
  sees 'cannot connect' 'head (lost)> '
  start_node head --coordinator --cell line --interface lo
  sees 'head is back' 'head@line> '
  type_in 'nodes --no-headers\r'
  sees 'active' 'head@line> '
}
