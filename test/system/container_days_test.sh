# Days that go wrong for a host whose steps run in containers (scenes/days_scene.sh). Its
# engine is its own, and goes with its power. These tests run alone: how soon an engine
# starts a container is not of ROSCell.

variants=(docker podman rootless)
. test/system/scenes/engine.sh
. test/system/scenes/days_scene.sh

before_all() {
  start_engine
}

after_all() {
  stop_engine
}

# start_day_with_engine: the third host of the cell runs its steps in containers of an
# engine of its own, which goes with its power.
start_day_with_engine() {
  use_engine
  bridge_hosts 3
  use_own_engine
  engine_inside=(nsenter --net="/run/netns/${hosts[2]}" "${engine_inside[@]}")
  trap 'stop_engine; clean_up' EXIT
  launch_engine || fail "$(tail "$engine_dir/log")"
  engine import "$base_tar" debian:bookworm-slim > /dev/null
  right_runtime=$runtime runtime=process
  right_user=("${inside[@]}")
  start_day
}

# boot_engine: of what the engine has in memory nothing is left by a cut of the power.
boot_engine() {
  grep -o " $engine_dir/[^ ]*" /proc/mounts | sort -r | xargs -r umount -l
  rm -rf "$engine_dir/exec" "$engine_dir/tmp" "$engine_dir/pid"
  launch_engine || fail "the engine did not start again: $(tail "$engine_dir/log")"
}

test_data_flow_after_bad_days_of_a_host_with_containers() {
  local what
  local -A name=([stop_node]="a node was stopped and started"
    [kill_node]="a node was killed"
    [kill_programs]="all that runs on a host was killed"
    [kill_host]="the power of a host was cut"
    [shut_down]="a host was shut down")
  [[ $variant != rootless || $(of_matrix suite whole) == whole ]] \
    || skip "in the whole matrix only (tools/testing/days.sh)"
  start_day_with_engine
  for what in $(of_matrix "kill_node kill_host shut_down" \
    "stop_node kill_node kill_programs kill_host shut_down"); do
    day_begins "${name[$what]}"
    "$what" right
    [[ $what != kill_host && $what != shut_down ]] || boot_engine
    start_host right
    day_ends 5
  done
}
