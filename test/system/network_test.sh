# A cell over several hosts: network namespaces on one bridge, with cuts made by
# the kernel, and one of six hosts on a network that loses packets, is slow or
# falls apart. ROSCELL_FAULT_SECONDS=600 makes the first two of these the ten
# minutes of the proof.

slow=(test_a_fifth_of_all_packets_lost_costs_no_member test_200_ms_between_hosts_keep_nobody_out_and_cost_no_member)

start_hosts() {
  bridge_hosts 3
  make_site_token
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  start_on 2 arm --join "$server"
  start_on 3 belt --join "$server"
  await_joined head arm
  await_joined head belt
}

test_a_cell_forms_over_three_hosts() {
  start_hosts
  expect "server" "${server%:*}" 10.231.7.1
  expect "active rows" "$(get head /v1/cell \
    | jq '[.nodes[] | select(.state == "active")] | length')" 3
}

test_a_node_off_this_host_is_refused_without_a_site_token() {
  bridge_hosts 2
  make_site_token
  start_on 1 head --coordinator --cell line
  inside=(ip netns exec "${hosts[1]}")
  start_node arm --interface 10.231.7.2 --join "$(discovery_of head)"
  inside=()
  await arm '.event == "join_refused"' > /dev/null
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 1
}

test_a_host_that_is_cut_off_is_lost_and_comes_back_as_the_same_member() {
  start_hosts
  ip link set "$(host_link 2)" down
  await head '.event == "node_lost" and .subject == "arm"' > "$scratch/lost.json"
  await arm '.event == "coordinator_lost"' > /dev/null
  expect "the other member" "$(row_state head belt)" active
  ip link set "$(host_link 2)" up
  await_joined head arm "$(jq .sequence "$scratch/lost.json")"
  expect "the row" "$(row_state head arm)" active
}

# cell_doctor [CHECK]: what the doctor finds, asked on the coordinator's host; its
# exit code.
cell_doctor() {
  ip netns exec "${hosts[0]}" "$ROSCELL" doctor --cell -o json \
    --to "$scratch/head/node.sock" ${1:+--only "$1"} \
    > "$scratch/found" 2> "$scratch/doctor.err"
}

# has_found VERDICT TEXT
has_found() {
  jq -es --arg how "$1" --arg seen "$2" \
    'any(.[][]; .verdict == $how and (.seen | contains($seen)))' \
    "$scratch/found" > /dev/null \
    || fail "no '$2' is $1: $(cat "$scratch/found" "$scratch/doctor.err")"
}

# in_the_way HOST_NUMBER RULE...: these packets do not come through.
in_the_way() {
  ip netns exec "${hosts[$(($1 - 1))]}" nft -f - << RULES
table inet wall {
  chain door {
    type filter hook prerouting priority -450
    ${*:2}
  }
}
RULES
}

test_doctor_says_of_each_pair_of_nodes_that_they_reach_each_other() {
  start_hosts
  cell_doctor reach,cell-clocks,cell-versions
  has_found ok "head reaches arm, belt"
  has_found ok "arm reaches belt, head"
  has_found ok "belt reaches arm, head"
  has_found ok "clocks differ by"
  has_found ok "3 nodes of version"
  expect "pairs that are not well" "$(jq '[.[] | select(.area == "cell"
    and .verdict != "ok")] | length' "$scratch/found")" 0
  expect "hosts" "$(cell_doctor; jq -r '[.[].node // empty] | unique | join(" ")' \
    "$scratch/found")" "arm belt"
}

test_doctor_names_each_thing_that_keeps_nodes_apart() {
  start_hosts
  in_the_way 1 ip saddr 10.231.7.2 udp dport "${server#*:}" drop
  in_the_way 2 "ip saddr 10.231.7.1 ip frag-off & 0x1fff != 0 drop"
  in_the_way 3 "ip saddr 10.231.7.2 udp dport 7400-7649 drop
    ip saddr 10.231.7.1 ip daddr 239.255.0.1 drop"
  ip -n "${hosts[2]}" link set eth0 mtu 1280
  cell_doctor && fail "it is content: $(cat "$scratch/found")"
  has_found broken \
    "arm -> head: discovery by udp port ${server#*:}: nothing comes back"
  has_found broken "head -> arm: large data by udp port"
  has_found broken "arm -> belt: data by udp port"
  has_found warning "head -> belt: multicast by udp port"
  jq -e 'any(.[]; .node == "belt" and .check == "mtu" and .verdict == "warning"
      and .remedy == "ssh -t 10.231.7.3 '"'sudo ip link set dev eth0 mtu 1500'"'")' \
    "$scratch/found" > /dev/null || fail "belt's MTU: $(cat "$scratch/found")"
  # What is larger than belt takes at once does not come.
  has_found broken "head -> belt: large data by udp port"
  has_found ok "belt reaches arm, head"
  ip -n "${hosts[2]}" link set eth0 mtu 1500
  local host
  for host in "${hosts[@]}"; do
    ip netns exec "$host" nft delete table inet wall
  done
  cell_doctor reach
  has_found ok "arm reaches belt, head"
  has_found ok "head reaches arm, belt"
}

test_doctor_tells_sessions_and_heartbeats_from_each_other() {
  start_hosts
  local port
  port=$(get arm /v1/node | jq -r '.identity.address | split(":")[1]')
  # What the session that is there needs still passes.
  in_the_way 2 "ip saddr 10.231.7.1 tcp dport $port tcp flags & (syn|ack) == syn drop"
  in_the_way 3 "ip saddr 10.231.7.2 udp dport $(get belt /v1/node \
    | jq -r '.identity.address | split(":")[1]') drop"
  cell_doctor reach && fail "it is content: $(cat "$scratch/found")"
  has_found broken "head -> arm: sessions by tcp port $port: nothing comes back"
  has_found warning "arm -> belt: heartbeats by udp port"
  has_found ok "belt reaches arm, head"
}

test_doctor_tells_of_a_firewall_before_the_ports_of_skills_only() {
  start_hosts
  # Open for what ROS 2 programs use, and not for a single skill.
  in_the_way 2 "ip saddr 10.231.7.1 udp dport 7490-7649 drop"
  # Wide enough for all skills of the host.
  in_the_way 3 "ip saddr 10.231.7.1 udp dport 7560-7649 drop"
  cell_doctor reach && fail "it is content: $(cat "$scratch/found")"
  has_found broken "head -> arm: data by udp port 7491: nothing comes back"
  has_found ok "head reaches belt"
}

test_doctor_reaches_a_node_by_the_second_address_of_its_host() {
  bridge_hosts 2
  make_site_token
  ip -n "${hosts[1]}" address flush dev eth0
  ip -n "${hosts[1]}" address add 10.231.7.22/24 dev eth0
  ip -n "${hosts[1]}" address add 10.231.7.2/24 dev eth0
  start_on 1 head --coordinator --cell line
  start_on 2 arm --join "$(discovery_of head)"
  await_joined head arm
  cell_doctor reach
  has_found ok "head reaches arm"
  has_found ok "arm reaches head"
}

test_doctor_looks_at_the_domain_of_the_cell() {
  bridge_hosts 2
  make_site_token
  start_on 1 head --coordinator --cell line --domain-id 7
  start_on 2 arm --join "$(discovery_of head)"
  await_joined head arm
  in_the_way 2 "ip saddr 10.231.7.1 udp dport 9150-9399 drop"
  cell_doctor reach,dds-ports && fail "it is content: $(cat "$scratch/found")"
  jq -e 'any(.[]; .node == "arm" and (.seen | contains("tries in domain 7")))' \
    "$scratch/found" > /dev/null || fail "$(cat "$scratch/found")"
  has_found broken "head -> arm: data by udp port 9241: nothing comes back"
}

test_doctor_says_whose_clock_is_off_by_how_much() {
  bridge_hosts 3
  make_site_token
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  with_bent_host CLOCK_OFFSET_S=-7 start_on 2 arm --join "$server"
  start_on 3 belt --join "$server"
  await_joined head arm
  await_joined head belt
  cell_doctor cell-clocks && fail "it is content: $(cat "$scratch/found")"
  # Heartbeats go between hosts with little delay, and not without any.
  jq -e 'length == 1 and .[0].verdict == "broken" and (.[0].seen
      | test("^arm.s clock is (6[.]9[0-9]*|7|7[.]0[0-9]*) s behind the coord"))
    and (.[0].remedy | startswith("ssh -t 10.231.7.2 "))' \
    "$scratch/found" > /dev/null || fail "$(cat "$scratch/found")"
  # What it says of itself, by its clock, is not what others go by.
  expect "its row" "$(row_state head arm)" active
}

test_doctor_says_which_node_is_of_another_version() {
  local version other
  version=$("$ROSCELL" --version | cut -d' ' -f2)
  other=${version%?}x
  mkdir "$scratch/other"
  ln -s "$ROSCELL_BUILD/bin/roscell-instance-shim" "$scratch/other"
  LC_ALL=C sed "s/${version//./[.]}/$other/g" "$ROSCELL" > "$scratch/other/roscell"
  chmod +x "$scratch/other/roscell"
  bridge_hosts 2
  make_site_token
  start_on 1 head --coordinator --cell line
  ROSCELL=$scratch/other/roscell start_on 2 arm --join "$(discovery_of head)"
  await_joined head arm
  cell_doctor cell-versions || fail "$(cat "$scratch/found" "$scratch/doctor.err")"
  has_found warning "arm is of version $other, its coordinator of $version"
  expect "findings" "$(jq length "$scratch/found")" 1
}

test_a_node_that_is_away_or_unknown_is_no_riddle() {
  start_hosts
  local text
  text=$("$ROSCELL" request --to "$scratch/arm/node.sock" \
    <<< '{"type":"actor_query","actor":"membership","node":"belt"}') \
    || fail "$text"
  jq -e '.actors[0].state.cell == "line"' <<< "$text" > /dev/null || fail "$text"
  text=$("$ROSCELL" request --to "$scratch/arm/node.sock" \
    <<< '{"type":"node_query","node":"nobody"}' 2>&1) && fail "$text"
  has_line "no node 'nobody'" <<< "$text"
}

# start_six [DELAY_MS]: a coordinator and five members, each on its host.
start_six() {
  local n
  bridge_hosts 6
  make_site_token
  [[ -z ${1:-} ]] || delay_packets "$1"
  start_on 1 head --coordinator --cell line
  server=$(discovery_of head)
  for n in 2 3 4 5 6; do
    start_on "$n" "node$n" --join "$server"
  done
  for n in 2 3 4 5 6; do
    await_joined head "node$n"
  done
}

# knock FROM TO: the host TO refuses FROM a connection to a port where nobody
# listens. Prints the seconds that this takes; false if there is no answer.
knock() {
  ip netns exec "${hosts[$1 - 1]}" curl -s --max-time 2 -o /dev/null \
    -w '%{time_total}' "http://10.231.7.$2:9/"
  [[ $? -eq 7 ]]
}

state_of() {
  get "$1" /v1/node | jq -r .state
}

active_rows() {
  get head /v1/cell | jq '[.nodes[] | select(.state == "active")] | length'
}

test_a_fifth_of_all_packets_lost_costs_no_member() {
  start_six
  # 20 % each way, for some leases.
  lose_packets 20
  loses_nobody head "${ROSCELL_FAULT_SECONDS:-40}"
  ip netns exec "${hosts[0]}" nft list table inet loss \
    | has_line 'packets [1-9]' || fail "no packet was lost"
  expect "active rows" "$(active_rows)" 6
}

test_200_ms_between_hosts_keep_nobody_out_and_cost_no_member() {
  start_six 200
  took=$(knock 2 3)
  expect "a round trip of $took s is long" "$(jq -n "$took >= 0.4")" true
  loses_nobody head "${ROSCELL_FAULT_SECONDS:-60}"
  expect "active rows" "$(active_rows)" 6
}

test_the_far_side_of_a_split_is_orphaned_and_returns_when_it_heals() {
  local n
  start_six
  split_bridge 4 5 6
  knock 2 3 > /dev/null || fail "the near side is not whole"
  knock 5 6 > /dev/null || fail "the far side is not whole"
  knock 2 6 > /dev/null && fail "the sides hear each other"
  for n in 4 5 6; do
    await head ".event == \"node_lost\" and .subject == \"node$n\"" \
      > "$scratch/lost$n.json"
    await "node$n" '.event == "coordinator_lost"' > "$scratch/alone$n.json"
    expect "node$n" "$(state_of "node$n")" orphaned
    expect "its row" "$(row_state head "node$n")" lost
  done
  for n in 2 3; do
    expect "node$n" "$(state_of "node$n")" member
    expect "its row" "$(row_state head "node$n")" active
  done
  heal_bridge
  for n in 4 5 6; do
    await_joined head "node$n" "$(jq .sequence "$scratch/lost$n.json")"
    await "node$n" '.event == "cell_joined"' \
      "$(jq .sequence "$scratch/alone$n.json")" > /dev/null
    expect "node$n" "$(state_of "node$n")" member
  done
  expect "active rows" "$(active_rows)" 6
}
