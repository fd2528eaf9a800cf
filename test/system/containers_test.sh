# Skills in containers of real engines, which these tests start and stop: Docker,
# Podman, and a Podman of a user who is not root.

variants=(docker podman rootless)
. test/system/scenes/engine.sh
. test/system/scenes/limited.sh
. test/system/scenes/terminal.sh
. test/system/scenes/commands.sh
. test/system/scenes/secrets.sh

before_all() {
  start_engine
}

after_all() {
  stop_engine
}

start_alone() {
  use_engine
  start_node head --coordinator --cell line --interface lo
}

# run_task TASK: deploys the echo skill; its container is in $container.
run_task() {
  # These tests look at how it ends, not at how it comes back.
  echo_task "$1" | jq '.pipeline[].restart = {policy: "never"}' \
    > "$scratch/$1.json"
  to head request "$scratch/$1.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  container=$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].container')
}

# echoes TASK LINE: the skill writes what it is given.
echoes() {
  local line
  rm -f "$scratch/seen"
  mkfifo "$scratch/seen"
  timeout "$deadline_s" tail -n +1 -F "$scratch/data/$1.out" \
    > "$scratch/seen" 2>/dev/null &
  echo "$2" >> "$scratch/data/$1.in"
  while read -r -t "$deadline_s" line; do
    [[ $line == "$2" ]] && return
  done < "$scratch/seen"
  fail "'$2' was not written"
}

terminate() {
  jq -n --arg task "$1" '{type: "task_termination", task: $task}' \
    | to head request > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
}

await_failed() {
  await head ".event == \"instance_changed\" and .data.state == \"failed\"
    and .subject == \"$instance\"" > /dev/null
}

inspect() {
  engine inspect "$container" --format "$1"
}

# say_last_words: of the skill, to be found at the end of its log.
say_last_words() {
  mv "$skills/echo/bin/echo" "$skills/echo/bin/real"
  cat > "$skills/echo/bin/echo" << 'SCRIPT'
#!/bin/sh
echo "last words"
exec /opt/roscell/skill/bin/real
SCRIPT
  chmod +x "$skills/echo/bin/echo"
}

test_the_example_for_containers_prints_in_one_what_its_page_shows() {
  start_alone
  mkdir -p "$scratch/data"
  echo one > "$scratch/data/words"
  sed "s#/tmp/ladder#$scratch/data#" docs/examples/08_containers.yaml \
    > "$scratch/task.yaml"
  to head run --wait-finished "$scratch/task.yaml" > "$scratch/said" 2>&1 \
    || fail "$(cat "$scratch/said")"
  expect "its output" "$(cat "$scratch/data/contained")" \
    "$(grep '^from a container' docs/examples/README.md)"
  [[ -n $(get head /v1/instances | jq -r '.instances[0].container // ""') ]] \
    || fail "it was no container"
}

test_the_log_of_a_stopped_task_is_there() {
  local text
  use_engine
  say_last_words
  start_node head --coordinator --cell line --interface lo
  run_task t
  await head ".event == \"instance_changed\" and .data.state == \"running\"
    and .subject == \"$instance\"" > /dev/null
  terminate t
  engine inspect "$container" > /dev/null 2>&1 && fail "the container is left"
  to head logs --previous > "$scratch/list"
  has_line "^$instance " "$scratch/list" || fail "$(cat "$scratch/list")"
  text=$(to head logs t 2> "$scratch/note") || fail "$(cat "$scratch/note")"
  has_line "^$instance on node head: stopped" "$scratch/note" \
    || fail "$(cat "$scratch/note")"
  expect "its log" "$text" "last words"
}

# space KIND: the container's namespace, as the kernel has it.
space() {
  readlink "/proc/$(inspect '{{.State.Pid}}')/ns/$1"
}

test_a_skill_runs_in_a_container_and_its_termination_removes_it() {
  start_alone
  expect "the runtime" "$(get head /v1/node | jq -r .runtime)" "$engine_name"
  run_task hello
  expect "the instance" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  expect "the container" "$(inspect '{{.State.Running}}')" true
  echoes hello "a line"
  expect "its task" "$(inspect '{{index .Config.Labels "roscell.task"}}')" hello
  expect "its instance" \
    "$(inspect '{{index .Config.Labels "roscell.instance"}}')" "$instance"
  expect "its cell" "$(inspect '{{index .Config.Labels "roscell.cell"}}')" line
  # Without root there are limits on few hosts only.
  [[ $variant == rootless ]] \
    || expect "its memory" "$(inspect '{{.HostConfig.Memory}}')" $((1024 << 20))
  expect "its network" "$(space net)" "$(readlink /proc/self/ns/net)"
  expect "its shared memory" "$(space ipc)" "$(readlink /proc/self/ns/ipc)"
  expect "its input" "$(inspect '{{range .Mounts}}{{.Source}} {{.RW}},{{end}}' \
    | tr , '\n' | grep hello.in)" "$scratch/data/hello.in false"
  to head logs "$instance" > "$scratch/log.txt" || fail "no log"
  terminate hello
  [[ -z $(engine ps -aq) ]] || fail "the container is still there"
  [[ -z $(ls "$scratch/head/notify") ]] || fail "its socket is still there"
  [[ -z $(ls "$scratch/head/build") ]] || fail "a build context is left"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

# show_powers: the skill says what it may, and whether it may write.
show_powers() {
  mv "$skills/echo/bin/echo" "$skills/echo/bin/real"
  cat > "$skills/echo/bin/echo" << 'SCRIPT'
#!/bin/sh
grep -E '^(Uid|Cap(Eff|Prm|Bnd|Amb)|NoNewPrivs):' /proc/self/status | tr '\t' ' '
for folder in /tmp /opt; do
  echo x > "$folder/of-a-skill" && echo "writes $folder"
done 2> /dev/null
exec /opt/roscell/skill/bin/real
SCRIPT
  chmod +x "$skills/echo/bin/echo"
  jq "$1" "$skills/echo/skill.json" > "$scratch/skill.json"
  cp "$scratch/skill.json" "$skills/echo/skill.json"
}

powers_of() {
  to head logs "$instance" > "$scratch/log.txt" || fail "no log"
  grep -E "^($1):" "$scratch/log.txt" | tr '\n' ';'
}

test_a_container_has_nothing_of_roots_power_and_gains_none() {
  local none=0000000000000000
  use_engine
  show_powers .
  start_node head --coordinator --cell line --interface lo
  run_task t
  expect "its powers" "$(powers_of 'CapEff|CapPrm|CapBnd|CapAmb|NoNewPrivs')" \
    "CapPrm: $none;CapEff: $none;CapBnd: $none;CapAmb: $none;NoNewPrivs: 1;"
  echoes t "a line"
  grep -qx "writes /tmp" "$scratch/log.txt" || fail "no /tmp"
  terminate t
}

test_a_container_has_what_its_node_grants_to_the_skill() {
  local some=0000000000002000
  use_engine
  show_powers '.models[].deployments[] += {capabilities: ["NET_RAW"], read_only: true}'
  start_node head --coordinator --cell line --interface lo
  echo_task t > "$scratch/t.json"
  to head request "$scratch/t.json" > "$scratch/reply.json"
  expect "code" "$(jq -r .error.code "$scratch/reply.json")" no_feasible_allocation
  grep -qF "skill 'echo' wants capability NET_RAW, which node 'head' does not grant \
it: grant = echo=capability:NET_RAW" "$scratch/reply.json" || fail "$(cat "$scratch/reply.json")"
  stop_node head
  start_node head --coordinator --cell line --interface lo \
    --grant echo=capability:NET_RAW
  run_task t
  expect "its powers" "$(powers_of 'CapEff|CapPrm|CapBnd|NoNewPrivs')" \
    "CapPrm: $some;CapEff: $some;CapBnd: $some;NoNewPrivs: 1;"
  grep -qx "writes /tmp" "$scratch/log.txt" || fail "no /tmp"
  ! grep -qx "writes /opt" "$scratch/log.txt" || fail "its root file system can be written"
  echoes t "a line"
  terminate t
}

test_an_image_is_built_once_and_then_reused() {
  start_alone
  run_task first
  image=$(inspect '{{.Config.Image}}')
  run_task second
  expect "the image" "$(inspect '{{.Config.Image}}')" "$image"
  terminate first
  terminate second
  # Another skill content is another image, for both at the same time.
  echo changed > "$skills/echo/note"
  stop_node head
  start_node head --coordinator --cell line --interface lo
  echo_task third | jq -c '.pipeline += [.pipeline[0] | .id = "again"
    | .output.endpoint += "2"]' | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  container=$(engine ps -q | head -n 1)
  [[ $(inspect '{{.Config.Image}}') != "$image" ]] || fail "the same image"
  expect "their image" "$(engine ps --format '{{.Image}}' | sort -u | wc -l)" 1
  # Everything up to the acceptance.
  sed '/"task_accepted"/q' < <(exec "$ROSCELL" events --since 0 -o json \
    --to "$scratch/head/node.sock" 2>/dev/null) > "$scratch/events"
  expect "builds" "$(grep -c '"image_built"' "$scratch/events")" 1
  terminate third
}

test_a_killed_node_finds_its_containers_again() {
  start_alone
  run_task steady
  stop_node head KILL
  expect "the container" "$(inspect '{{.State.Running}}')" true
  start_node head --coordinator --cell line --interface lo
  # It was killed so soon that its last record may be of the start.
  await head '(.event == "instance_adopted" or .event == "instance_changed")
    and .data.state == "running"' > /dev/null
  expect "its id" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].container')" "$container"
  expect "its state" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  echoes steady "after the restart"
  terminate steady
  [[ -z $(engine ps -aq) ]] || fail "the container is still there"
}

test_a_container_that_ends_while_its_node_is_away_is_told() {
  start_alone
  run_task short
  stop_node head KILL
  engine kill "$container" > /dev/null
  start_node head --coordinator --cell line --interface lo
  await_failed
  expect "its exit code" "$(get head "/v1/instances/$instance" \
    | jq '.instances[0].exit_code')" 137
  terminate short
}

test_a_killed_container_is_told_with_its_exit_code_and_last_lines() {
  use_engine
  say_last_words
  start_node head --coordinator --cell line --interface lo
  run_task doomed
  engine kill "$container" > /dev/null
  await_failed
  get head "/v1/instances/$instance" | jq '.instances[0]' > "$scratch/row.json"
  expect "its exit code" "$(jq .exit_code "$scratch/row.json")" 137
  expect "its reason" "$(jq -r .reason "$scratch/row.json")" \
    "it ended by signal 9"
  jq -r .log_tail "$scratch/row.json" | has_line "last words" \
    || fail "$(cat "$scratch/row.json")"
  to head logs "$instance" | has_line "last words" || fail "not in its log"
  terminate doomed
}

test_a_container_that_is_out_of_memory_is_told_as_such() {
  [[ $variant != rootless || -e /sys/fs/cgroup/cgroup.controllers ]] \
    || skip "without root nothing is bounded by cgroups of version 1"
  use_engine
  make_later_hungry
  start_node head --coordinator --cell line --interface lo
  limited_task t later | to head request > "$scratch/reply.json" \
    || fail "$(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  await_failed
  to head instances > "$scratch/said"
  has_line "out of memory: it may use 64 MiB" "$scratch/said" \
    || fail "$(cat "$scratch/said")"
  expect "the row" "$(get head "/v1/instances/$instance" \
    | jq '.instances[0].out_of_memory')" true
}

# use_base NAME: the skill's base image.
use_base() {
  local text
  text=$(jq --arg base "$1" '.models[].deployments[].base_image = $base' \
    "$skills/echo/skill.json")
  echo "$text" > "$skills/echo/skill.json"
}

# refused TASK: the refusal of a task, in refusal.json.
refused() {
  echo_task "$1" | to head request > "$scratch/refusal.json"
  expect "exit code" $? 1
  expect "code" "$(jq -r .error.code "$scratch/refusal.json")" engine_failed
}

says() {
  jq -r ".error.$1" "$scratch/refusal.json" | has_line "$2" \
    || fail "no '$2' in: $(cat "$scratch/refusal.json")"
}

test_a_failed_build_is_told_with_the_end_of_its_log() {
  use_engine
  # In this one /opt is a file.
  touch "$scratch/opt"
  tar -C "$scratch" -c opt | engine import - odd:1 > /dev/null
  use_base odd:1
  start_node head --coordinator --cell line --interface lo
  refused bad
  says message "cannot be built"
  says log_tail "COPY opt /opt"
  expect "containers" "$(engine ps -aq | wc -l)" 0
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_a_full_disk_of_the_engine_is_told_with_the_remedy() {
  use_engine
  # With room for less than the skill.
  mkdir "$scratch/engine"
  mount -t tmpfs -o size=64m tmpfs "$scratch/engine" \
    || skip "no tmpfs can be mounted"
  trap 'stop_engine; umount -l "$scratch/engine"; clean_up' EXIT
  use_own_engine
  launch_engine || skip "the engine does not run on a tmpfs"
  mkdir "$scratch/root"
  tar -C "$scratch/root" -c . | engine import - debian:bookworm-slim > /dev/null
  head -c 100M /dev/urandom > "$skills/echo/large"
  start_node head --coordinator --cell line --interface lo
  refused large
  says message "no space left on device"
  says message "free space on the engine's disk"
}

test_a_base_image_that_cannot_be_had_is_told_with_the_remedy() {
  use_engine
  use_base registry.invalid/none:1
  start_node head --coordinator --cell line --interface lo
  refused bad
  says message "cannot be built"
  says message "$engine_name pull registry.invalid/none:1"
}

test_an_engine_that_dies_in_the_middle_of_a_build_is_told() {
  use_engine
  # A registry that takes connections and says nothing.
  local silent port
  exec {silent}< <(exec python3 -c 'import signal, socket
server = socket.create_server(("127.0.0.1", 0))
print(server.getsockname()[1], flush=True)
signal.pause()')
  echo $! >> "$scratch/pids"
  read -r port <&"$silent"
  use_base "127.0.0.1:$port/slow:1"
  start_node head --coordinator --cell line --interface lo
  echo_task slow | to head request > "$scratch/refusal.json" &
  request=$!
  await head '.event == "image_building" and (.data.step | test("FROM|pull"))' \
    > /dev/null
  expect "the state" "$(get head /v1/instances | jq -r '.instances[0].state')" \
    building
  end_engine KILL
  wait "$request"
  expect "exit code" $? 1
  says message "went away"
  launch_engine || fail "the engine did not start again"
  await head '.event == "engine_found"' > /dev/null
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_an_engine_that_dies_in_the_middle_of_a_run_is_told_and_asked_again() {
  start_alone
  run_task cut
  program=$(inspect '{{.State.Pid}}')
  end_engine KILL
  await head '.event == "engine_lost"' > /dev/null
  await head '.event == "engine_found" or .event == "engine_lost"' > /dev/null
  get head "/v1/instances/$instance" | jq '.instances[0]' > "$scratch/row.json"
  expect "the state" "$(jq -r .state "$scratch/row.json")" running
  jq -r .trouble "$scratch/row.json" | has_line "$engine_socket" \
    || fail "no trouble: $(cat "$scratch/row.json")"
  # A new task is refused at once, and says why.
  refused other
  says message "$engine_socket"
  # What happens meanwhile is learnt afterwards.
  kill -KILL "$program"
  launch_engine || fail "the engine did not start again"
  await_failed
  get head "/v1/instances/$instance" | jq '.instances[0]' > "$scratch/row.json"
  expect "its exit code" "$(jq .exit_code "$scratch/row.json")" 137
  expect "trouble" "$(jq -r '.trouble // ""' "$scratch/row.json")" ""
  terminate cut
  run_task anew
  echoes anew "a line"
  terminate anew
}

test_containers_that_outlive_their_engine_go_on() {
  use_engine
  # Podman needs no option for it.
  local option=--live-restore
  [[ $engine_name == docker ]] || option=
  end_engine
  launch_engine $option || fail "the engine did not start again"
  start_node head --coordinator --cell line --interface lo
  run_task tough
  end_engine KILL
  await head '.event == "engine_lost"' > "$scratch/lost.json"
  echoes tough "without an engine"
  launch_engine $option || fail "the engine did not start again"
  await head '.event == "engine_found"' > /dev/null
  expect "the state" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].state')" running
  echoes tough "with the engine again"
  engine kill "$container" > /dev/null
  await_failed
  terminate tough
}

test_a_user_without_permission_on_the_socket_is_told_what_to_do() {
  use_engine
  mkdir "$scratch/nobody"
  chown 65533 "$scratch" "$scratch/nobody"
  chmod a+rx "$suite" "$engine_dir"
  timeout "$deadline_s" setpriv --reuid 65533 --regid 65533 --clear-groups "$ROSCELL" node \
    --name other --data-dir "$scratch/nobody" --interface lo --port 0 \
    --runtime "$runtime" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "no permission" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  local remedy="group docker"
  [[ $engine_name == docker ]] || remedy="enable --now podman.socket"
  grep -q "$remedy" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
}

test_an_engine_that_is_not_there_is_told_what_to_do() {
  timeout "$deadline_s" "$ROSCELL" node --name other --data-dir "$scratch/other" --interface lo \
    --port 0 --runtime "$engine_name:$scratch/none.sock" 2> "$scratch/stderr"
  expect "exit code" $? 3
  grep -q "$scratch/none.sock" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
}

test_auto_takes_the_engine_that_answers() {
  use_engine
  runtime=auto
  DOCKER_HOST=unix://$engine_socket \
    start_node head --coordinator --cell line --interface lo
  expect "the runtime" "$(get head /v1/node | jq -r .runtime)" "$engine_name"
  grep -q "instances are run by '$engine_name': .*$engine_socket" \
    "$scratch/head.log" || fail "$(cat "$scratch/head.log")"
}

# start_with_gpu: a node that believes to have a GPU, and a skill that wants it.
start_with_gpu() {
  local text
  mkdir "$scratch/nvml"
  ln -s "$(find "$ROSCELL_BUILD" -name 'libfake_nvml.so')" \
    "$scratch/nvml/libnvidia-ml.so.1"
  text=$(jq '.models[].deployments[].resources.gpu_memory_mib = 64' \
    "$skills/echo/skill.json")
  echo "$text" > "$skills/echo/skill.json"
  inside+=(env "LD_LIBRARY_PATH=$scratch/nvml")
  start_node head --coordinator --cell line --interface lo
}

test_a_gpu_that_the_engine_cannot_give_is_told_with_the_remedy() {
  use_engine
  [[ ! -e /etc/cdi && -z $(ls /run/cdi 2>/dev/null) ]] \
    && ! command -v nvidia-container-runtime-hook > /dev/null \
    || skip "this host may have a GPU"
  start_with_gpu
  refused seeing
  says message "cannot be started\|cannot be created"
  says message "nvidia"
  says message "nvidia-ctk"
  expect "containers" "$(engine ps -aq | wc -l)" 0
}

test_podman_gives_the_gpu_that_was_chosen_by_its_cdi_name() {
  use_engine
  [[ $engine_name == podman ]] \
    || skip "Docker gives GPUs by NVIDIA's runtime only, which needs one"
  # A device of no use, described as NVIDIA's tools describe theirs.
  mkdir -p "$scratch/cdi" /run/cdi
  jq -n '{cdiVersion: "0.4.0", kind: "nvidia.com/gpu", devices: [
    {name: "0", containerEdits: {env: ["MADE_UP_GPU=0"]}},
    {name: "2", containerEdits: {env: ["MADE_UP_GPU=2"]}}]}' \
    > "$scratch/cdi/nvidia.json"
  use_own_engine
  engine_inside=(unshare -m bash -c 'mount --bind "$0" /run/cdi; exec "$@"'
    "$scratch/cdi" "${engine_inside[@]}")
  trap 'stop_engine; clean_up' EXIT
  launch_engine || fail "$(tail "$engine_dir/log")"
  engine import "$base_tar" debian:bookworm-slim > /dev/null
  start_with_gpu
  run_task seeing
  expect "its GPU" "$(tr '\0' '\n' < "/proc/$(inspect '{{.State.Pid}}')/environ" \
    | grep -E 'GPU|CUDA' | sort | paste -sd ' ')" \
    "CUDA_VISIBLE_DEVICES=0 MADE_UP_GPU=0 ROSCELL_GPU=0"
  terminate seeing
}

test_a_command_runs_in_the_container_of_its_instance() {
  local program
  start_alone
  run_task t
  commands_work
  program=$(engine inspect "$container" --format '{{.State.Pid}}')
  for space in mnt pid; do
    expect "its namespace" "$(say readlink "/proc/self/ns/$space")" \
      "$(readlink "/proc/$program/ns/$space")"
  done
  program=$(pgrep -P "$program" | head -n 1)
  expect "the capabilities" "$(say grep Cap /proc/self/status)" \
    "$(grep Cap "/proc/$program/status")"
  expect "the variables" "$(say env | grep '^ROSCELL_PARAMETERS=')" \
    "$(tr '\0' '\n' < "/proc/$program/environ" \
      | grep '^ROSCELL_PARAMETERS=')"
  commands_are_told
  goes_on t after
}

test_what_goes_through_a_container_comes_back() {
  start_alone
  run_task t
  bytes_come_back
}

test_a_command_in_a_container_has_a_terminal() {
  start_alone
  run_task t
  a_terminal_serves_a_command
}

test_a_command_in_a_container_ends_with_its_client_its_instance_and_its_node() {
  start_alone
  run_task t
  begin_long
  kill -TERM "$client"
  long_ends 143
  begin_long
  kill -KILL "$client"
  long_ends 137
  goes_on t after
  begin_long
  to head stop t > "$scratch/said" || fail "$(cat "$scratch/said")"
  long_ends 137 'the command was ended: the instance has ended'
  run_task u
  begin_long
  stop_node head KILL
  long_ends 3 'the command is out of reach'
}

test_a_container_reads_its_secrets_and_nobody_else_has_them() {
  local folder since
  start_alone
  printf %s "$key_value" | give head key
  printf %s "$pass_value" | give head pass
  run_with_secrets t
  container=$(get head "/v1/instances/$instance" | jq -r '.instances[0].container')
  expect "its file" "$(to head exec -n "$instance" -- cat /run/secrets/key)" "$key_value"
  expect "its variables" "$(to head exec -n "$instance" -- sh -c 'echo "$PASSWORD $ROSCELL_SECRETS"')" \
    "$pass_value /run/secrets"
  expect "its mode" "$(to head exec -n "$instance" -- stat -c %a /run/secrets/key)" 400
  to head exec -n "$instance" -- sh -c 'echo x > /run/secrets/other' 2> "$scratch/err" \
    && fail "it can be written"
  engine image inspect "$(inspect '{{.Image}}')" > "$scratch/answer"
  not_in "the image" "$scratch/answer"
  nobody_has_them head
  lines_come t first
  folder=$(inspect '{{range .Mounts}}{{if eq .Destination "/run/secrets"}}{{.Source}}{{end}}{{end}}')
  expect "where it lies" "$(stat -f -c %T "$folder")" tmpfs
  printf other-key | give head key
  since=$("$ROSCELL" events --to "$scratch/head/node.sock" --no-follow -o json 2> /dev/null \
    | jq -s 'map(.sequence) | max')
  engine kill -s KILL "$container" > "$scratch/killed" 2>&1
  await head ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"running\"" "$since" > /dev/null
  expect "after a new start" "$(to head exec -n "$instance" -- cat /run/secrets/key)" other-key
  lines_come t second
  expect "all frames" "$(sort -u "$scratch/data/t.out" | wc -l)" 10
  terminate t
  [[ ! -e $folder ]] || fail "its files are left: $(ls -l "$folder")"
}

test_parameters_of_a_container_change_while_it_runs() {
  start_alone
  run_task t
  echoes t one
  to head set "$instance" "prefix=b " > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  echo two >> "$scratch/data/t.in"
  timeout "$deadline_s" grep -m 1 -x "b two" > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/t.out" 2> /dev/null) \
    || fail "no 'b two': $(tail -n 3 "$scratch/data/t.out")"
  expect "its container" "$(get head "/v1/instances/$instance" \
    | jq -r '.instances[0].container')" "$container"
}
