# A cell of six hosts on a network that loses packets, is slow or falls apart.
# ROSCELL_FAULT_SECONDS=600 makes the first two the ten minutes of the proof.

slow=(test_a_fifth_of_all_packets_lost_costs_no_member test_200_ms_between_hosts_keep_nobody_out_and_cost_no_member)

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
