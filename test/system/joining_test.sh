# Why a node does not join, as its log and its status say it: hosts in network
# namespaces, and the causes made for real.

# said NAME: the first problem that the node has told, with the remedy.
said() {
  await "$1" '.event == "join_failed" or .event == "join_refused"' \
    | jq -r '.data.reason + " | " + (.data.hint // "")'
}

# expect_said NAME TEXT...: the node's first problem holds each text, in
# its event, in its log and in its status.
expect_said() {
  local name=$1 words text shown
  shift
  words=$(said "$name")
  shown=$(get "$name" /v1/node | jq -r '.joining[0] | .trouble + " | " + (.hint // "")')
  for text in "$@"; do
    [[ $words == *"$text"* ]] || fail "$name says '$words', not '$text'"
    [[ $shown == *"$text"* ]] || fail "$name shows '$shown', not '$text'"
    grep -qF -- "$text" "$scratch/$name.log" || fail "not in the log: '$text'"
  done
}

# start_usual HOST_NUMBER NAME [OPTION...]: a node with the usual ports.
start_usual() {
  discovery_port=11811 http_port=8420
  start_on "$@"
  discovery_port=0 http_port=0
}

# start_head [HOSTS]: a coordinator with the usual ports on the first host.
start_head() {
  bridge_hosts "${1:-2}"
  make_site_token
  start_usual 1 head --coordinator --cell line
}

test_a_node_says_within_5_s_that_nothing_listens_where_it_is_to_join() {
  bridge_hosts 2
  make_site_token
  local begin=$SECONDS
  start_on 2 arm --join 10.231.7.1
  expect_said arm "nothing listens on UDP port 11811 of 10.231.7.1" \
    "is the coordinator running there?"
  ((SECONDS - begin <= 6)) || fail "it took $((SECONDS - begin)) s"
  to arm status > "$scratch/status"
  grep -q '^joining  *10.231.7.1:11811: nothing listens' "$scratch/status" \
    || fail "$(cat "$scratch/status")"
  start_usual 1 head --coordinator --cell line
  await arm '.event == "cell_joined"' > /dev/null
  grep -q "joined cell 'line'" "$scratch/arm.log" || fail "it is not logged"
  expect "joining" "$(get arm /v1/node | jq -c .joining)" null
}

test_a_node_says_that_it_was_given_the_http_port() {
  start_head
  start_on 2 arm --join 10.231.7.1:8420
  expect_said arm "port 8420 is the HTTP port of coordinator 'head'" \
    "use --join 10.231.7.1:11811"
}

test_a_node_that_is_to_join_a_member_is_told_its_coordinator() {
  start_head 3
  start_usual 2 belt --join 10.231.7.1
  await_joined head belt
  start_on 3 arm --join 10.231.7.2
  expect_said arm "node 'belt' at 10.231.7.2 is a member of cell 'line'" \
    "use --join 10.231.7.1:11811"
}

test_a_node_without_the_site_token_says_so() {
  start_head
  inside=(ip netns exec "${hosts[1]}")
  start_node arm --interface 10.231.7.2 --join 10.231.7.1
  inside=()
  expect_said arm "node 'arm' has no site token, and cell 'line' wants one" \
    "copy the site token of the coordinator at 10.231.7.1 to '$ROSCELL_SITE_TOKEN'"
}

test_another_sites_token_accuses_neither_side_falsely() {
  start_head
  inside=(ip netns exec "${hosts[1]}")
  head -c 32 /dev/urandom | od -An -tx1 | tr -d ' \n' > "$scratch/other.token"
  start_node arm --interface 10.231.7.2 --join 10.231.7.1 \
    --site-token "$scratch/other.token"
  inside=()
  expect_said arm \
    "the site token of node 'arm' is not that of node 'head' of cell 'line'"
  await head '.event == "session_refused"
    and (.data.message | contains("the site token of node '"'arm'"'"))' \
    > /dev/null
}

# drop_udp HOST_NUMBER VERDICT: that host's firewall stops UDP to discovery.
drop_udp() {
  ip netns exec "${hosts[$(($1 - 1))]}" nft -f - 2> /dev/null << RULES ||
table inet guard {
  chain arriving {
    type filter hook input priority 0
    udp dport 11811 $2
  }
}
RULES
    skip "this kernel's nftables cannot filter here"
}

test_a_firewall_on_udp_alone_is_told_as_one() {
  start_head
  drop_udp 1 drop
  start_on 2 arm --join 10.231.7.1
  expect_said arm "does not answer on UDP port 11811: a firewall drops UDP" \
    "let UDP port 11811"
}

test_a_host_that_is_not_there_is_told_as_silent_or_out_of_reach() {
  bridge_hosts 2
  make_site_token
  start_on 2 arm --join 10.231.7.77
  said arm > "$scratch/words"
  grep -qE "10.231.7.77 does not answer at all|no way to 10.231.7.77" \
    "$scratch/words" || fail "$(cat "$scratch/words")"
}

test_a_node_joins_by_a_host_name_and_says_when_there_is_none() {
  start_head
  echo "10.231.7.1 base.roscell" > "$scratch/hosts"
  inside=(ip netns exec "${hosts[1]}" unshare -m sh -c
    "mount --bind $scratch/hosts /etc/hosts && exec \"\$@\"" sh)
  start_node arm --interface 10.231.7.2 --site-token "$scratch/site.token" \
    --join base.roscell
  inside=()
  await_joined head arm
  start_on 2 belt --join nobody.invalid
  expect_said belt "the name 'nobody.invalid' does not resolve"
}

test_a_node_that_sees_no_coordinator_says_which_domain_it_looks_at() {
  start_node arm --interface lo
  expect_said arm "no coordinator is visible on the public domain"
}

test_a_member_has_its_coordinator_answer_for_the_cell() {
  start_node head --interface lo --coordinator --cell line
  start_node arm --interface lo --join "$(discovery_of head)"
  await_joined head arm
  to arm nodes -o json | jq -e 'length == 2' > /dev/null \
    || fail "no nodes from the member"
  echo_task say | to arm request - > "$scratch/reply"
  expect "reply" "$(jq -r .type "$scratch/reply")" task_accepted
  expect "tasks" "$(to arm tasks -o json | jq -r '.[0].name')" say
  to arm cells > /dev/null || fail "no cells from the member"
  to arm release belt > "$scratch/refused" 2>&1 && fail "it was passed on"
  grep -q "coordinator of cell 'line' at 127.0.0.1" "$scratch/refused" \
    || fail "$(cat "$scratch/refused")"
  stop_node head KILL
  await arm '.event == "coordinator_lost"' > /dev/null
  to arm nodes > "$scratch/away" 2>&1 && fail "nobody can have answered"
  grep -q "coordinator of cell 'line'.* is away" "$scratch/away" \
    || fail "$(cat "$scratch/away")"
}

test_a_member_returns_to_its_cell_after_the_cell_got_another_name() {
  discovery_port=$((20000 + BASHPID % 20000))
  start_node head --interface lo --coordinator --cell line
  local server
  server=$(discovery_of head)
  start_node arm --interface lo --join "$server"
  await arm '.event == "cell_joined"' > /dev/null
  stop_node head
  start_node head --interface lo --coordinator --cell belt-line
  await arm '.event == "cell_joined" and .data.cell == "belt-line"' > /dev/null
}
