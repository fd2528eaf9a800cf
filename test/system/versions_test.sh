# A cell half of whose nodes are of an earlier version, as for as long as an upgrade
# takes (docs/upgrade.md). $ROSCELL_OLD is the build folder of that version.

. test/system/scenes/days_scene.sh

need_earlier_version() {
  [[ -n ${ROSCELL_OLD:-} ]] \
    || skip "ROSCELL_OLD names no build folder of an earlier version"
  [[ -x $ROSCELL_OLD/bin/roscell ]] \
    || fail "there is no $ROSCELL_OLD/bin/roscell"
}

# told WHAT FILTER COMMAND...: what is said of the cell passes the jq filter,
# whichever version asks, and whichever is asked.
told() {
  local what=$1 filter=$2 program name
  shift 2
  for program in "$ROSCELL_BUILD" "$ROSCELL_OLD"; do
    for name in head left right; do
      ROSCELL=$program/bin/roscell to "$name" "$@" -o json \
        > "$scratch/told.json" 2> "$scratch/told.err" \
        || fail "$what, asked of $name by $program: $(cat "$scratch/told.err")"
      jq -e "$filter" "$scratch/told.json" > /dev/null \
        || fail "$what, asked of $name by $program:" \
          "$(cut -c1-600 "$scratch/told.json")"
    done
  done
}

each_version_tells_of_the_cell() {
  told "the tasks" 'length == 5 and all(.state == "running")' tasks
  told "the instances" 'length > 0 and all(.state == "running")' instances
  told "the nodes" 'map(select(.state == "active")) | length == 3' nodes
  told "the topics" 'length >= 8' topics
}

# half_a_cell NODE...: of the earlier version. Frames flow and go on when a member of each version
# has ended and begun anew. Each version has a camera and a reader of the other's.
half_a_cell() {
  need_earlier_version
  local name
  for name in "$@"; do build_of[$name]=$ROSCELL_OLD; done
  start_day
  each_version_tells_of_the_cell
  stop_node left
  start_host left
  all_flow 10 "after the earlier version began anew"
  stop_node right
  start_host right
  all_flow 10 "after this version began anew"
  kill_node right
  start_host right
  each_version_tells_of_the_cell
  day_ends 10
}

test_data_flow_where_a_coordinator_and_a_member_are_of_an_earlier_version() {
  half_a_cell head left
}

test_data_flow_where_a_member_is_of_an_earlier_version() {
  half_a_cell left
}

# take_echo: a skill that no node has, to be added.
take_echo() {
  cp -r "$ROSCELL_BUILD/skills/echo" "$scratch"
  ask_no_cpu "$scratch/echo"
}

test_a_skill_goes_to_nodes_of_this_version_beside_one_of_an_earlier_version() {
  need_earlier_version
  build_of[left]=$ROSCELL_OLD
  start_day
  take_echo
  "$ROSCELL" skill add "$scratch/echo" --to "$scratch/head/node.sock" \
    > "$scratch/added" 2>&1 || fail "not added: $(cat "$scratch/added")"
  run_on right hello
  lines_come hello first
  echo_task elsewhere left > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/refusal.json" \
    && fail "a node of an earlier version got it: $(cat "$scratch/refusal.json")"
  expect "the code" "$(jq -r .error.code "$scratch/refusal.json")" \
    no_feasible_allocation
  has_line left "$scratch/refusal.json" || fail "$(cat "$scratch/refusal.json")"
  possible=$EPOCHREALTIME
  all_flow 10 "beside a skill that came"
  stop_node right
  start_host right
  lines_come hello second
  day_ends 10
}

test_a_coordinator_of_an_earlier_version_is_given_no_skill() {
  need_earlier_version
  local node
  build_of[head]=$ROSCELL_OLD
  start_day
  take_echo
  for node in head right; do
    "$ROSCELL" skill add "$scratch/echo" --to "$scratch/$node/node.sock" \
      > "$scratch/refusal" 2>&1 && fail "added: $(cat "$scratch/refusal")"
    has_line "hint: " "$scratch/refusal" || fail "$(cat "$scratch/refusal")"
  done
  possible=$EPOCHREALTIME
  day_ends 10
}
