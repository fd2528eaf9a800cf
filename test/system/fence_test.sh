# Steps that may move when their node is lost: nothing of them outlives the time
# after which they are placed elsewhere, whatever becomes of their node.

variants=(process docker podman rootless)
[[ $variant == process ]] || . test/system/scenes/engine.sh

before_all() {
  [[ $variant == process ]] || start_engine
}

after_all() {
  [[ $variant == process ]] || stop_engine
}

# Three leases, the least that can be asked for; a lease before that the step
# has ended.
after_s=24
fence_s=16

# run_movable: the step runs on the member `arm`. $program is the number of its
# process, which the shim has started.
run_movable() {
  [[ $variant == process ]] || use_engine
  start_node head --coordinator --cell line --interface lo
  start_node arm --interface lo --join "$(discovery_of head)" \
    --label place=arm
  await_joined head arm
  echo_task mobile arm | jq --argjson after "$after_s" \
    '.pipeline[0].on_node_loss = {policy: "move", after_s: $after}' \
    > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  container=$(get arm "/v1/instances/$instance" \
    | jq -r '.instances[0].container')
  if [[ $variant == process ]]; then
    program=$(readlink "$scratch/arm/instances/$instance/pid" | cut -d' ' -f3)
  else
    program=$(pgrep -P "$(engine inspect "$container" \
      --format '{{.State.Pid}}')")
  fi
  [[ -d /proc/$program ]] || fail "the step does not run"
}

# ends_alone: the program ends in time, and its shim says that it was the fence.
ends_alone() {
  timeout $((fence_s + 5)) tail --pid="$program" -f /dev/null \
    || fail "it has outlived its fence"
  if [[ $variant == process ]]; then
    # The node that is to reap it may be stopped.
    timeout "$deadline_s" python3 - "${container%%:*}" << 'WAIT' \
      || fail "its shim has not ended"
import os, select, sys
try:
    select.select([os.pidfd_open(int(sys.argv[1]))], [], [])
except ProcessLookupError:
    pass  # It has ended before.
WAIT
    expect "fenced" "$(jq .fenced "$scratch/arm/instances/$instance/exit")" true
  else
    expect "its exit" "$(engine wait "$container")" 137
  fi
}

test_a_step_that_may_move_ends_though_its_node_was_killed() {
  run_movable
  # As long as the node is heard it goes on, beyond its first fence.
  loses_nobody head $((fence_s + 2))
  [[ -d /proc/$program ]] || fail "it has ended while its node was heard"
  stop_node arm KILL
  ends_alone
}

test_a_step_that_may_move_ends_though_its_node_is_stopped() {
  run_movable
  kill -STOP "${pid[arm]}"
  ends_alone
  kill -CONT "${pid[arm]}"
}

test_a_step_that_may_move_goes_on_when_its_node_is_back_in_time() {
  run_movable
  stop_node arm KILL
  start_node arm --interface lo --join "$(discovery_of head)" \
    --label place=arm
  await arm '.event == "cell_joined"' > /dev/null
  loses_nobody head $((fence_s + 2))
  [[ -d /proc/$program ]] || fail "it has ended though its node was back"
}
