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
