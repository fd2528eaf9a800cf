# Addresses that change, come late or go: hosts in network namespaces.

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

test_a_member_whose_address_changes_keeps_its_row_and_starts_its_step_anew() {
  start_pair
  echo_task hello arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  local uuid begin=$SECONDS
  uuid=$(get arm /v1/node | jq -r .identity.uuid)
  has_address 2 22
  await head '.event == "node_joined" and (.data.address | startswith("10.231.7.22:"))' \
    > /dev/null
  ((SECONDS - begin <= 10)) || fail "it took $((SECONDS - begin)) s"
  await arm '.event == "address_changed" and .data.from == "10.231.7.2"
    and .data.to == "10.231.7.22"' > /dev/null
  await arm '.event == "instance_changed" and .data.state == "running"' > /dev/null
  expect "its UUID" "$(get arm /v1/node | jq -r .identity.uuid)" "$uuid"
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 2
  expect "the step" "$(get head /v1/instances \
    | jq -r '.instances[0] | "\(.state) \(.ends[0].reason)"')" \
    "running the address of this host has changed from 10.231.7.2 to 10.231.7.22"
  tr '\0' '\n' < "/proc/$(cut -d' ' -f1 "$scratch"/arm/instances/*/pid)/environ" \
    | has_line "^ROS_DISCOVERY_SERVER=.*10\.231\.7\.22:" \
    || fail "it was not told of the server at the new address"
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

test_a_node_waits_for_its_interface_and_says_what_there_is() {
  bridge_hosts 1
  make_site_token
  local host=${hosts[0]}
  has_address 1
  ip netns exec "$host" "$ROSCELL" node --name head --coordinator \
    --data-dir "$scratch/head" --interface eth0 --runtime process --port 0 \
    --discovery-port 0 --site-token "$scratch/site.token" \
    --public-domain "$public_domain" 2> "$scratch/head.log" &
  echo $! >> "$scratch/pids"
  said head "interface 'eth0' has no IPv4 address"
  ip link set "$(host_link 1)" down
  has_address 1 1
  said head "interface 'eth0' (10.231.7.1) has no carrier"
  ip link set "$(host_link 1)" up
  said head "node 'head' listens on 10.231.7.1:"
}
