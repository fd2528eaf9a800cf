# Cells that form by themselves and by name, exchange nodes and let them go. Most
# tests are on loopback, where nodes see each other as on one network.

slow=(test_a_transfer_survives_the_death_of_each_party_at_each_step)

# start_cells NAME...: coordinators that see each other.
start_cells() {
  local cell other
  for cell in "$@"; do
    start_node "$cell" --interface lo --coordinator --cell "$cell"
  done
  for cell in "$@"; do
    for other in "$@"; do
      [[ $cell == "$other" ]] || await "$cell" \
        ".event == \"peer_joined\" and .subject == \"$other\"" > /dev/null
    done
  done
}

# start_batch COUNT: so many nodes, started at the same moment: all processes
# wait at one barrier first. Options may follow.
start_batch() {
  local count=$1 i
  shift
  mkfifo "$scratch/barrier"
  exec {barrier}<> "$scratch/barrier"
  for ((i = 1; i <= count; ++i)); do
    (
      read -r _ < "$scratch/barrier"
      exec "$ROSCELL" node --name "n$i" --data-dir "$scratch/n$i" \
        --interface lo --port 0 --skills "$skills" --runtime process \
        --public-domain "$public_domain" "$@" 2>> "$scratch/n$i.log"
    ) &
    pid[n$i]=$!
    echo "${pid[n$i]}" >> "$scratch/pids"
  done
  for ((i = 1; i <= count; ++i)); do
    echo go >&"$barrier"
  done
}

active_rows() {
  get "$1" /v1/cell | jq '[.nodes[] | select(.state == "active")] | length'
}

# watch_cells CELL...: a line for each event of these, on $changes.
watch_cells() {
  local cell
  exec {changes}< <(for cell in "$@"; do
    "$ROSCELL" events --since 0 --to "$scratch/$cell/node.sock" -o json \
      2> /dev/null &
    echo $! >> "$scratch/pids"
  done; wait)
}

# await_even TOTAL CELL...: until the cells have so many members in all, the
# coordinators counted, and their sizes differ by at most one.
await_even() {
  local total=$1 cell end=$((SECONDS + deadline_s)) sizes
  shift
  # Any of these may be the last to change.
  watch_cells "$@"
  while read -r -t $((end - SECONDS)) _ <&"$changes"; do
    sizes=$(for cell in "$@"; do active_rows "$cell"; done)
    [[ $(awk '{sum += $1} END {print sum}' <<< "$sizes") -eq $total ]] \
      || continue
    [[ $(sort -n <<< "$sizes" | sed -n '1h;${G;s/\n/ /p}' \
      | awk '{print $1 - $2}') -le 1 ]] && return
  done
  fail "the sizes are" $sizes
}

ask() {
  jq -nc "$2" | to "$1" request
}

form() {
  local cell=$1
  shift
  jq -nc '{type: "cell_formation", members: $ARGS.positional}' --args "$@" \
    | to "$cell" request
}

transfer() {
  ask "$1" "{type: \"node_transfer\", node: \"$2\", target: \"$3\",
             instances: \"${4:-refuse}\"}"
}

release() {
  ask "$1" "{type: \"node_release\", node: \"$2\",
             instances: \"${3:-refuse}\"}"
}

results() {
  jq -r '[.outcomes[] | .node + " " + .result] | join(", ")'
}

code_of() {
  jq -r '.error.code // "none"'
}

test_nodes_started_at_the_same_moment_spread_evenly() {
  start_cells alpha beta gamma
  start_batch 13
  await_even 16 alpha beta gamma
}

test_nodes_that_were_there_first_spread_over_the_coordinators_that_come() {
  start_batch 9
  start_cells alpha beta gamma
  await_even 12 alpha beta gamma
}

test_a_coordinator_that_dies_in_the_middle_leaves_the_others_even() {
  start_cells alpha beta gamma
  start_batch 10
  await beta '.event == "node_joined"' > /dev/null
  stop_node beta KILL
  # Its own members are orphans and wait for it; who has no cell yet finds one.
  local others
  others=$(jq -s 'length' < <(for name in alpha gamma; do
    get $name /v1/cell | jq -c '.nodes[] | select(.state == "active")'; done))
  [[ $others -ge 2 ]] || fail "alpha and gamma have $others nodes"
  local end=$((SECONDS + deadline_s)) orphans joined
  watch_cells alpha gamma
  while read -r -t $((end - SECONDS)) _ <&"$changes"; do
    orphans=$(get alpha /v1/cell \
      | jq '[.free[]? | select(.state == "orphaned")] | length')
    joined=$(($(active_rows alpha) + $(active_rows gamma)))
    [[ $((orphans + joined)) -eq 12 ]] || continue
    local difference=$(($(active_rows alpha) - $(active_rows gamma)))
    [[ ${difference#-} -le 1 ]] && return
  done
  fail "orphans $orphans, members $joined"
}

test_nodes_are_brought_in_by_name_from_nowhere_and_from_other_cells() {
  start_cells alpha beta
  for name in one two three; do
    start_node $name --interface lo --wait
  done
  expect "first" "$(form alpha one two nobody beta | results)" \
    "one joined, two joined, nobody failed, beta failed"
  expect "again" "$(form alpha one two | results)" \
    "one already_member, two already_member"
  expect "from both" "$(form beta two three | results)" \
    "two joined, three joined"
  expect "alpha" "$(active_rows alpha)" 2
  expect "beta" "$(active_rows beta)" 3
  expect "a name twice" "$(form beta one one | jq -r .error.where)" /members/1
  expect "a stranger to the cell" "$(row_state alpha two)" ""
}

test_any_coordinator_moves_and_releases_a_node_of_any_cell() {
  start_cells alpha beta
  start_node one --interface lo --wait
  form alpha one > /dev/null
  expect "asked of the target" "$(transfer beta one beta | jq -r .to)" beta
  expect "asked of the old cell" "$(transfer alpha one alpha | jq -r .to)" alpha
  expect "its own cell" "$(transfer beta one alpha | code_of)" conflict
  expect "no such cell" "$(transfer beta one gamma | code_of)" unknown_cell
  expect "no such node" "$(transfer beta two beta | code_of)" unknown_node
  expect "a coordinator" "$(transfer alpha alpha beta | code_of)" conflict
  expect "released" "$(release beta one | jq -r .cell)" alpha
  expect "state" "$(get one /v1/node | jq -r .state)" independent
  expect "released again" "$(release beta one | code_of)" unknown_node
}

# run_echo CELL: the task `say` on any node of the cell but its coordinator.
run_echo() {
  echo_task say member | to "$1" request | jq -r '.instances[0].node'
}

test_what_runs_on_a_node_that_leaves_is_refused_terminated_or_moved() {
  start_cells alpha beta
  start_node one --interface lo --wait --label place=member
  form alpha one > /dev/null
  expect "placed" "$(run_echo alpha)" one
  expect "by default" "$(transfer alpha one beta | code_of)" conflict
  grep -q say-say- <<< "$(transfer alpha one beta | jq -r .error.message)" \
    || fail "the instance is not named"
  expect "no room" "$(transfer alpha one beta reschedule | code_of)" \
    no_feasible_allocation
  expect "still there" "$(row_state alpha one)" active
  start_node two --interface lo --wait --label place=member
  form alpha two > /dev/null
  transfer alpha one beta reschedule > "$scratch/moved.json"
  expect "moved" "$(jq -c .rescheduled "$scratch/moved.json")" '["say"]'
  expect "where it runs" \
    "$(get alpha /v1/tasks | jq -r '.tasks[0].instances[0].node')" two
  expect "the task" "$(get alpha /v1/tasks | jq -r '.tasks[0].state')" running
  expect "nothing is left" "$(get one /v1/instances | jq '.instances | length')" 0
  echo hello >> "$scratch/data/say.in"
  release beta two terminate > "$scratch/released.json"
  expect "ended" "$(jq -c .terminated "$scratch/released.json")" '["say"]'
  expect "tasks" "$(get alpha /v1/tasks | jq '.tasks | length')" 0
}

test_a_node_that_is_started_again_is_where_it_was_last() {
  start_cells alpha beta
  start_node one --interface lo --join "$(discovery_of alpha)"
  await_joined alpha one
  transfer alpha one beta > /dev/null
  stop_node one KILL
  start_node one --interface lo --join "$(discovery_of alpha)"
  await one '.event == "cell_joined" and .data.cell == "beta"' > /dev/null
  release beta one > /dev/null
  stop_node one
  start_node one --interface lo --join "$(discovery_of alpha)"
  expect "released" "$(get one /v1/node | jq -r .state)" independent
  stop_node one
  start_node one --interface lo --join "$(discovery_of beta)"
  await one '.event == "cell_joined" and .data.cell == "beta"' > /dev/null
}

test_a_coordinator_that_is_started_again_knows_its_cell() {
  local port
  start_node alpha --interface lo --coordinator --cell alpha
  start_node one --interface lo --label place=member
  start_node two --interface lo
  await_joined alpha one
  await_joined alpha two
  expect "placed" "$(run_echo alpha)" one
  local before
  before=$(get one /v1/instances | jq -r '.instances[0].container')
  stop_node two KILL
  await alpha '.event == "node_lost" and .subject == "two"' > /dev/null
  stop_node alpha KILL
  await one '.event == "coordinator_lost"' > /dev/null
  expect "an orphan" "$(get one /v1/node | jq -r .state)" orphaned
  start_node alpha --interface lo --coordinator --cell alpha
  await_joined alpha one
  expect "the one that is away" "$(row_state alpha two)" expected
  expect "the instance" \
    "$(get one /v1/instances | jq -r '.instances[0].container')" "$before"
  expect "the task" "$(get alpha /v1/tasks | jq -r '.tasks[0].state')" running
}

test_a_cell_name_in_use_is_refused_unless_forced() {
  start_cells alpha
  timeout "$deadline_s" "$ROSCELL" node --name other --data-dir "$scratch/other" \
    --interface lo --port 0 --discovery-port 0 --coordinator --cell alpha \
    --public-domain "$public_domain" 2> "$scratch/refused" \
    && fail "it started"
  grep -q "the cell name 'alpha' is in use" "$scratch/refused" \
    || fail "$(cat "$scratch/refused")"
  start_node other --interface lo --coordinator --cell alpha --force
  await alpha '.event == "cell_name_conflict"' > /dev/null
  expect "both are shown" "$(to alpha cells -o json \
    | jq -c '[.[].coordinator] | sort')" '["alpha","other"]'
}

# A switch by the REST API of a node, with a proof that is none.
post_switch() {
  curl -sS --max-time "$deadline_s" -d "$2" \
    "http://$(get "$1" /v1/node | jq -r .identity.address)/v1/registration"
}

# forged_order NAME: a switch of that node by somebody who knows all but the
# site token.
forged_order() {
  get "$1" /v1/node | jq -c '.identity
    | {type: "registration_switch", transfer: "x-1", node: .name, uuid, epoch,
       origin: "chosen", nonce: ("0" * 64), proof: ("0" * 64)}'
}

test_only_who_proves_the_site_token_switches_a_node() {
  start_cells alpha beta
  make_site_token
  start_node one --interface lo --wait --site-token "$scratch/site.token"
  start_node two --interface lo --wait
  form alpha two > /dev/null
  local address order
  address=$(get one /v1/node | jq -r .identity.address)
  expect "what a stranger learns" \
    "$(curl -sS "http://$address/v1/registration" | code_of)" unauthorized
  order=$(forged_order one)
  expect "a false proof" "$(post_switch one "$order" | code_of)" unauthorized
  expect "another message" \
    "$(post_switch one '{"type": "node_query"}' | code_of)" unauthorized
  expect "without the token" "$(form alpha one | jq -r '.outcomes[0].code')" \
    unauthorized
  # A member is its coordinator's, token or not.
  order=$(forged_order two)
  expect "a member" "$(post_switch two "$order" | code_of)" unauthorized
  expect "state" "$(get one /v1/node | jq -r .state)" independent
  expect "the member" "$(get two /v1/node | jq -r .state)" member
}

# start_party NAME: one of the parties of the transfers below, for the first time
# or again.
start_party() {
  case $1 in
    alpha) start_on 1 alpha --coordinator --cell alpha ;;
    beta) start_on 2 beta --coordinator --cell beta ;;
    n*) start_on "${1#n}" "$1" --wait ;;
  esac
}

# await_settled NODE: until it is a member, and of one cell only.
await_settled() {
  local end=$((SECONDS + deadline_s)) rows
  watch_cells alpha beta
  while read -r -t $((end - SECONDS)) _ <&"$changes"; do
    rows=$(row_state alpha "$1" | grep -c active)$(row_state beta "$1" \
      | grep -c active)
    [[ $rows == 01 || $rows == 10 ]] || continue
    [[ $(get "$1" /v1/node | jq -r .state) == member ]] && return
  done
  fail "alpha: $(row_state alpha "$1"), beta: $(row_state beta "$1"), $1:" \
    "$(get "$1" /v1/node | jq -r .state)"
}

# die_at WATCHED EVENT VICTIM: n3 is transferred, and the victim is killed when
# the watched node tells of that event.
die_at() {
  local from=alpha to=beta line stream reader
  [[ $(row_state beta n3) == active ]] && from=beta to=alpha
  local watched=$1 victim=$3
  [[ $watched == old ]] && watched=$from
  [[ $watched == new ]] && watched=$to
  [[ $victim == old ]] && victim=$from
  [[ $victim == new ]] && victim=$to
  local last
  last=$(timeout 2 "$ROSCELL" events --since 0 -o json \
    --to "$scratch/$watched/node.sock" | tail -1 | jq .sequence)
  exec {stream}< <(exec "$ROSCELL" events --since "$last" -o json \
    --to "$scratch/$watched/node.sock" 2> /dev/null)
  reader=$!
  transfer $from n3 $to > "$scratch/transfer.json" 2> /dev/null &
  local asker=$!
  while read -r -t "$deadline_s" line <&"$stream"; do
    [[ $line == *"\"$2\""* ]] && break
  done
  kill -KILL "${pid[$victim]}"
  kill "$reader" 2> /dev/null
  exec {stream}<&-
  wait "$asker"
  timeout "$deadline_s" tail --pid="${pid[$victim]}" -f /dev/null
  start_party "$victim"
  await_settled n3
  echo "$2, $3: $(jq -r '.error.code // .to' "$scratch/transfer.json")" >&2
}

test_a_transfer_survives_the_death_of_each_party_at_each_step() {
  bridge_hosts 6
  make_site_token
  local name victim
  for name in alpha beta n3 n4 n5 n6; do
    start_party $name
  done
  for name in n3 n4 n5 n6; do
    await alpha ".event == \"node_appeared\" and .subject == \"$name\"" \
      > /dev/null
  done
  form alpha n3 n4 n5 n6 > /dev/null
  for victim in n3 old new; do
    die_at old node_departing $victim
    die_at n3 switch_accepted $victim
    die_at new node_joined $victim
  done
  for name in n4 n5 n6; do
    await_settled $name
    expect "$name" "$(row_state alpha $name)" active
  done
}
