# Stock ROS 2 programs and skills of one cell, in containers of real engines and
# beside them.

variants=(docker podman rootless)
. test/system/scenes/engine.sh
. test/system/scenes/ros2_scene.sh

before_all() {
  start_engine || return
  import_ros2_image
}

after_all() {
  stop_engine
}

# The base image with a workspace where ROS 2 would be, and the libraries of its
# program.
import_ros2_image() {
  local root=$suite/ros2 prefix=/opt/ros/test
  make_workspace "$root$prefix" "$prefix"
  mkdir "$root$prefix/libraries"
  ldd "$ROSCELL_BUILD/bin/stock_program" | awk '$2 == "=>" {print $3}' \
    | xargs cp -t "$root$prefix/libraries"
  echo "export LD_LIBRARY_PATH=$prefix/libraries" >> "$root$prefix/setup.bash"
  cp "$base_tar" "$suite/ros2.tar"
  # Docker takes no folder twice, so files only.
  (cd "$root" && find . -type f -print0 | tar -rf "$suite/ros2.tar" --null -T -)
  engine import "$suite/ros2.tar" test/ros2:stock > /dev/null
}

# The image's own setup.bash is found without being named.
relay_in_image() {
  relay_descriptor | jq 'del(.ros2.setup)
    | .models[].deployments[] |= (.base_image = "test/ros2:stock"
      | .resources.memory_mib = 1024)'
}

relay_step() {
  jq -nc '
    {id: "relay", operation: "relay", model: "stock",
     input: {protocol: "ros2", endpoint: "/scene/image",
             data_type: "sensor_msgs/msg/Image"},
     output: {protocol: "ros2", endpoint: "/scene/passed_on",
              data_type: "sensor_msgs/msg/Image"}}'
}

# start_contained_scene STEP: on one host, in containers. Without a step those who
# look at the pictures have them from the camera where $interface is set.
start_contained_scene() {
  use_engine
  take_skills
  local name
  for name in image_source pose_estimation; do
    allow_much_memory "$skills/$name"
  done
  mkdir -p "$skills/relay" "$scratch/data"
  relay_in_image > "$skills/relay/skill.json"
  [[ $variant != rootless ]] || chown -R "$rootless_user" "$scratch"
  start_node head --coordinator --cell hall --interface "${interface:-lo}"
  scene "$1" | jq --arg to "$scratch/data/poses" --arg alone "${interface:-}" '
      del(.pipeline[].labels)
      | (.pipeline[] | select(.id == "poses")) |= (.output.endpoint = $to
        | if $alone != "" then .input[0] |= (.endpoint = "/scene/image"
          | del(.external)) else . end)' \
    | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  ln -s "$scratch/data/poses" "$scratch/poses"
}

test_a_stock_program_in_an_image_with_ros_2_runs_as_a_step_between_skills() {
  start_contained_scene "$(relay_step)"
  expect "containers" "$(engine ps -q | wc -l)" 3
  poses_come
  jq -n '{type: "task_termination", task: "scene"}' | to head request \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  [[ -z $(engine ps -aq) ]] || fail "a container is still there"
}

test_a_stock_program_beside_containers_exchanges_images_with_skills_in_them() {
  start_contained_scene ''
  start_guest desk 1
  poses_come
  stop_guest
  # And as somebody else.
  start_guest desk 1 setpriv --reuid 1 --regid 1 --clear-groups
  poses_come
  stop_guest
}

test_skills_in_containers_go_on_at_another_address() {
  local interface=rca$BASHPID containers
  ip link add "$interface" type veth peer name "$interface-far"
  ip link set "$interface-far" up
  ip link set "$interface" up
  ip addr add 10.231.8.1/24 dev "$interface"
  start_contained_scene ''
  poses_come
  containers=$(engine ps -q | sort)
  ip addr flush dev "$interface"
  ip addr add 10.231.8.2/24 dev "$interface"
  await_anew head 10.231.8.2
  await head '.event == "instance_address_changed" and .data.step == "poses"' \
    > /dev/null
  poses_come
  expect "containers" "$(engine ps -q | sort)" "$containers"
  expect "restarts" "$(get head /v1/instances \
    | jq -c '[.instances[] | [.state, .restarts // 0]] | unique')" '[["running",0]]'
  ip link del "$interface"
}

# start_contained_relay [OPTION...]: a stock program in a container, on the
# interfaces of its host.
start_contained_relay() {
  local run=/opt/ros/test/lib/stock_demo/relay
  engine ps -q | xargs -r docker -H "unix://$engine_socket" rm -f > /dev/null
  engine run -d --network=host -e ROS_DOMAIN_ID=41 --ulimit nofile=1024 \
    --ulimit nproc=4096 "$@" test/ros2:stock bash -c ". /opt/ros/test/setup.bash; exec $run std_msgs/msg/String" \
    > "$scratch/container" || fail "the container does not run"
  exec 7< <(engine logs -f "$(< "$scratch/container")" 2>&1)
  read -r -t "$deadline_s" said <&7 || fail "the container says nothing"
  [[ $said == relays* ]] || fail "$said"
}

# doctor_says VERDICTS WORDS: of the shared memory of this host's programs.
doctor_says() {
  ROSCELL_TO=unix:$scratch/none.sock "$ROSCELL" doctor -o json \
    --only shm-sharing --data-dir "$scratch/none" > "$scratch/found" 2>&1
  jq -e --arg verdict "$1" --arg words "$2" 'any(.[]; (.verdict | test($verdict))
    and (.seen | contains($words)))' "$scratch/found" > /dev/null \
    || fail "no '$2': $(cat "$scratch/found")"
}

# start_relay_as COMMAND...: a stock program on the host, begun by the command.
start_relay_as() {
  exec 8< <(exec env ROS_DOMAIN_ID=41 "$@" "$ROSCELL_BUILD/bin/stock_program" \
    std_msgs/msg/String)
  echo $! >> "$scratch/pids"
  read -r said <&8
}

test_doctor_names_a_container_that_does_not_share_its_hosts_memory() {
  local same=(env)
  use_engine
  [[ $variant != rootless ]] || same=("${as_rootless_user[@]}")
  start_relay_as "${same[@]}"
  start_contained_relay
  doctor_says broken "has another /dev/shm than "
  start_contained_relay --ipc=host
  # Not all hosts show root the processes of a first one that watches them.
  doctor_says 'ok|skipped' "programs: 2"
  start_relay_as setpriv --reuid 7 --regid 7 --clear-groups
  doctor_says broken "domain 41: stock_program (pid "
  doctor_says broken ", user 7) may not share memory with "
}
