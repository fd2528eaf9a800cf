# A cell over several hosts: network namespaces on one bridge, with cuts made by
# the kernel.

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
