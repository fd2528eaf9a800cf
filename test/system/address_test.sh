# Addresses that change, come late or go: hosts in network namespaces.

. test/system/scenes/ros2_scene.sh

# start_there HOST_NUMBER NAME [OPTION...]: a node on one of these hosts, at
# whatever address its interface has.
start_there() {
  inside=(ip netns exec "${hosts[$(($1 - 1))]}")
  start_node "$2" --interface eth0 --site-token "$scratch/site.token" "${@:3}"
  inside=()
}

# has_address HOST_NUMBER [LAST_BYTE]: the only one that its interface has from
# now on, or none.
has_address() {
  ip -n "${hosts[$(($1 - 1))]}" addr flush dev eth0
  [[ -z ${2:-} ]] \
    || ip -n "${hosts[$(($1 - 1))]}" addr add "10.231.7.$2/24" dev eth0
}

start_pair() {
  bridge_hosts 2
  make_site_token
  discovery_port=11811
  start_there 1 head --coordinator --cell line --label place=head
  discovery_port=0
  start_there 2 arm --join 10.231.7.1 --label place=arm
  await_joined head arm
}

# said NAME TEXT: its log has it, or gets it in time. The events of a node end
# when it is made anew, its log does not.
said() {
  timeout "$deadline_s" grep -qm 1 -- "$2" \
    <(tail -n +1 -F "$scratch/$1.log" 2> /dev/null) \
    || fail "$1 does not say '$2': $(cat "$scratch/$1.log")"
}

# start_pictures: a camera and a stock program as a step on the member's host, and
# who looks at its pictures, and at what the program passes on, at the coordinator's.
start_pictures() {
  take_skills
  make_workspace
  mkdir "$skills/relay"
  relay_descriptor > "$skills/relay/skill.json"
  start_pair
  scene "$(jq -nc '
    {id: "relay", operation: "relay", model: "stock", labels: {place: "arm"},
     input: {protocol: "ros2", endpoint: "/scene/image",
             data_type: "sensor_msgs/msg/Image"},
     output: {protocol: "ros2", endpoint: "/scene/passed_on",
              data_type: "sensor_msgs/msg/Image"}}')" \
    | jq --arg to "$scratch/direct" '.pipeline += [.pipeline[]
        | select(.id == "poses") | .id = "direct" | .output.endpoint = $to
        | .input[0] |= (.endpoint = "/scene/image" | del(.external))]' \
    | to head request - > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  come_in "$deadline_s" direct
  come_in "$deadline_s" poses
}

# row_of STEP FILTER: of its instance, as the cell shows it.
row_of() {
  get head /v1/instances \
    | jq -r --arg step "$1" ".instances[] | select(.spec.step == \$step) | $2"
}

# process_of NAME STEP: what this node runs it in, which a new start replaces.
process_of() {
  readlink "$scratch/$1/instances/$(row_of "$2" .spec.instance)/pid"
}

# come_in SECONDS READER: some pictures more get to this reader.
come_in() {
  local file=$scratch/$2 before begin=$EPOCHREALTIME
  before=$(cat "$file" 2> /dev/null | wc -l)
  timeout "$1" grep -m $((before + 3)) corners > "$file.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$file" 2> /dev/null) \
    || fail "$2: $(($(wc -l < "$file") - before)) pictures in $1 s"
  echo "    $2: pictures after $(seconds_since "$begin") s"
}

test_a_skill_of_the_engine_goes_on_at_another_address_and_others_are_restarted() {
  start_pictures
  local uuid camera poses change="the address of this host has changed from"
  uuid=$(get arm /v1/node | jq -r .identity.uuid)
  camera=$(process_of arm camera)
  poses=$(process_of head poses)
  has_address 2 22
  # Below 10 s where nothing else runs.
  come_in 20 direct
  come_in "$deadline_s" poses
  await head '.event == "node_joined" and (.data.address | startswith("10.231.7.22:"))' \
    > /dev/null
  await arm '.event == "address_changed" and .data.from == "10.231.7.2"
    and .data.to == "10.231.7.22"' > /dev/null
  await arm '.event == "instance_address_changed" and .data.step == "camera"
    and .data.from == "10.231.7.2" and .data.to == "10.231.7.22"' > /dev/null
  expect "its UUID" "$(get arm /v1/node | jq -r .identity.uuid)" "$uuid"
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 2
  expect "the stock program" "$(row_of relay '"\(.state) \(.ends[0].reason)"')" \
    "running $change 10.231.7.2 to 10.231.7.22"
  expect "the camera" "$(row_of camera '"\(.state) \(.restarts // 0) \(.ends | length)"')" \
    "running 0 0"
  to head logs "$(row_of camera .spec.instance)" > "$scratch/log"
  has_line "this host has another address: inputs and outputs were made anew" \
    < "$scratch/log" || fail "its log: $(cat "$scratch/log")"
  # That of the coordinator, whose skills hear of it in the same way. Its member
  # notices when its lease of 8 s is over.
  has_address 1 11
  come_in 20 direct
  # A node that is started again knows where its skills are.
  stop_node arm KILL
  start_there 2 arm --join 10.231.7.1 --label place=arm
  await arm '.event == "cell_joined"' > /dev/null
  come_in "$deadline_s" poses
  expect "the reader" "$(row_of poses '"\(.state) \(.restarts // 0)"')" "running 0"
  expect "the camera" "$(row_of camera '"\(.state) \(.restarts // 0)"')" "running 0"
  expect "its process" "$(process_of arm camera)" "$camera"
  expect "the reader's process" "$(process_of head poses)" "$poses"
}

test_a_coordinator_goes_on_at_its_new_address() {
  start_pair
  has_address 1 11
  said head "address_changed 'head' from=10.231.7.1 interface=eth0 to=10.231.7.11"
  expect "its server" "$(discovery_of head)" 10.231.7.11:11811
  expect "its cell" "$(get head /v1/cell | jq -r .cell)" line
}

test_a_short_gap_of_an_address_changes_nothing_and_a_long_one_renews() {
  start_pair
  has_address 2
  has_address 2 2
  has_address 2
  # Longer than what is tolerated, by the clock of the test.
  timeout 2 tail -f /dev/null
  has_address 2 2
  said arm "address_returned 'arm' address=10.231.7.2"
  await arm '.event == "cell_joined"' > /dev/null
  expect "renewals" "$(grep -c "is made anew" "$scratch/arm.log")" 1
}

test_an_address_that_was_given_as_one_and_goes_ends_the_node() {
  bridge_hosts 1
  make_site_token
  start_on 1 head --coordinator
  has_address 1
  wait "${pid[head]}"
  expect "exit code" $? 3
  said head "address 10.231.7.1 is not of this host any more"
}

# start_waiting: a node on the first host, which cannot start yet.
start_waiting() {
  ip netns exec "${hosts[0]}" "$ROSCELL" node --name head --coordinator \
    --data-dir "$scratch/head" --interface eth0 --runtime process --port 0 \
    --discovery-port 0 --site-token "$scratch/site.token" \
    --public-domain "$public_domain" 2> "$scratch/head.log" &
  pid[head]=$!
  echo "${pid[head]}" >> "$scratch/pids"
}

# waits_for TEXT COMMAND...: it says so by its socket.
waits_for() {
  local text=$1 code=0
  shift
  to head "$@" > "$scratch/answer" 2>&1 || code=$?
  expect "exit code of $1" "$code" 1
  has_line -- "the node waits for its interface: $text" < "$scratch/answer" \
    || fail "$1 says: $(cat "$scratch/answer")"
}

test_a_node_waits_for_its_interface_and_says_what_there_is() {
  bridge_hosts 1
  make_site_token
  local nothing="interface 'eth0' has no IPv4 address, and IPv6 is not used; this host has: lo 127.0.0.1, eth0 (no"
  has_address 1
  start_waiting
  said head "$nothing"
  waits_for "$nothing" status
  waits_for "$nothing" doctor
  waits_for "$nothing" tasks
  has_line "SIGTERM ends the node" < "$scratch/answer" || fail "no remedy"
  echo_task hello > "$scratch/task.json"
  waits_for "$nothing" request "$scratch/task.json"
  stop_node head
  wait "${pid[head]}"
  expect "exit code" $? 0
  [[ ! -e $scratch/head/node.sock ]] || fail "its socket is left"
  start_waiting
  said head "$nothing"
  ip link set "$(host_link 1)" down
  has_address 1 1
  said head "interface 'eth0' (10.231.7.1) has no carrier"
  waits_for "interface 'eth0' (10.231.7.1) has no carrier" status
  ip link set "$(host_link 1)" up
  said head "node 'head' listens on 10.231.7.1:"
  await head '.event == "node_started"' > /dev/null
}
