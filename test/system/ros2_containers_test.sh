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
