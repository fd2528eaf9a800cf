# tools/launch.sh: a node in a container, and its skills in others beside it.

variants=(docker podman rootless)
. test/system/scenes/engine.sh

# What the node's image is made from: this build, and a skill that has room for
# the sanitizers' memory.
before_all() {
  start_engine || return
  mkdir -p "$suite/build/bin" "$suite/build/skills"
  cp "$ROSCELL" "$ROSCELL_BUILD/bin/roscell-instance-shim" "$suite/build/bin"
  cp -r "$ROSCELL_BUILD/skills/echo" "$suite/build/skills"
  jq '.models[].deployments[].resources |= (.cpu = 0 | .memory_mib = 1024)' \
    "$ROSCELL_BUILD/skills/echo/skill.json" > "$suite/build/skills/echo/skill.json"
  chmod -R a+rX "$suite"
  engine import --change "ENV ASAN_OPTIONS=${ASAN_OPTIONS:-}" "$base_tar" \
    launch-base:1 > /dev/null
}

after_all() {
  stop_engine
}

# launch [OPTION...]: a node "arm" in a container, which joins the coordinator
# "head", a process.
launch() {
  "${inside[@]}" tools/launch.sh --engine "$engine_socket" \
    --binary "$suite/build" --base launch-base:1 --share "$scratch/data" \
    --data-dir "$scratch/arm" --name arm --label place=arm \
    --port 0 --public-domain "$public_domain" \
    --join "$(discovery_of head)" "$@" 2> "$scratch/launch.err"
}

start_cell() {
  use_engine
  mkdir -p "$scratch/data"
  runtime=process start_node head --coordinator --cell line --interface lo
}

test_a_container_of_the_hosts_network_comes_into_no_cell_without_its_token() {
  start_cell
  mkdir "$scratch/other"
  [[ $variant != rootless ]] || chown "$rootless_user" "$scratch/other"
  local -x ROSCELL_SITE_TOKEN=$scratch/other/site.token
  launch --interface lo --detach || fail "$(cat "$scratch/launch.err")"
  await arm '.event == "join_refused"' > "$scratch/refused.json"
  jq -e '.data.reason | contains("has no site token")' "$scratch/refused.json" \
    > /dev/null || fail "$(cat "$scratch/refused.json")"
  expect "nodes" "$(get head /v1/cell | jq '.nodes | length')" 1
}

# The names of the containers that run.
running() {
  engine ps --format '{{.Names}}' | sort | paste -sd ' '
}

test_a_launched_node_joins_and_its_skills_run_beside_it_and_outlive_it() {
  start_cell
  launch --interface lo --detach || fail "$(cat "$scratch/launch.err")"
  await_joined head arm
  expect "the containers" "$(running)" roscell-node
  echo_task hello arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  expect "the containers" "$(running)" "roscell-$instance roscell-node"
  local before
  before=$(engine ps -q --filter "name=roscell-$instance")
  # Launched again it takes over what it left, and builds nothing.
  launch --interface lo --detach --label shift=late \
    || fail "$(cat "$scratch/launch.err")"
  grep -q building "$scratch/launch.err" && fail "the image was built again"
  await arm '.event == "instance_adopted"' > /dev/null
  expect "its label" "$(get arm /v1/node | jq -r .resources.labels.shift)" late
  expect "the container" "$(engine ps -q --filter "name=roscell-$instance")" \
    "$before"
  expect "the instance" "$(get arm "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  await_joined head arm
  jq -n '{type: "task_termination", task: "hello"}' | to head request \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  expect "the containers" "$(running)" roscell-node
  "${inside[@]}" tools/launch.sh stop --engine "$engine_socket" \
    || fail "it cannot be stopped"
  expect "the containers" "$(engine ps -aq)" ""
  await head '.event == "node_left" and .subject == "arm"' > /dev/null
}

test_an_interrupt_ends_a_launched_node_in_order() {
  start_cell
  set -m # Else this shell's children would ignore it.
  launch --interface=lo &
  local launcher=$!
  set +m
  await_joined head arm
  kill -INT -- "-$launcher"
  timeout "$deadline_s" tail --pid="$launcher" -f /dev/null \
    || fail "it does not end"
  await head '.event == "node_left" and .subject == "arm"' > /dev/null
  expect "the containers" "$(engine ps -aq)" ""
}

test_a_terminal_is_asked_for_the_interface_of_a_launched_node() {
  start_cell
  command -v script > /dev/null || skip "script is missing"
  export -f launch discovery_of get
  export engine_socket suite scratch public_domain deadline_s
  # Loopback is the last one.
  printf 'none\n%s\n' "$(ip -4 -o addr show up | wc -l)" \
    | "${inside[@]}" env SHELL=/bin/bash script -qec 'launch --detach' /dev/null \
      > "$scratch/asked" || fail "$(cat "$scratch/asked" "$scratch/launch.err")"
  await_joined head arm
  grep -qE '^ +[0-9]+  lo  127.0.0.1' "$scratch/launch.err" \
    || fail "$(cat "$scratch/launch.err")"
}

test_a_launched_node_takes_no_processes() {
  tools/launch.sh --runtime process 2> "$scratch/launch.err"
  expect "exit code" $? 2
  grep -q "containers beside it" "$scratch/launch.err" \
    || fail "$(cat "$scratch/launch.err")"
}
