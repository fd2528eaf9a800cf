# Who is let in on one host: nodes of one user meet without an option, and nobody
# else gets anything by being on the same machine.

stranger=65534

# as_stranger COMMAND...: another user of this host, who has a folder of his own.
as_stranger() {
  env -u ROSCELL_SITE_TOKEN "HOME=$scratch/theirs" \
    setpriv --reuid "$stranger" --regid "$stranger" --clear-groups "$@"
}

# let_in_strangers: they have a folder, and see that of the test, as /tmp is seen.
let_in_strangers() {
  [[ $(id -u) -eq 0 ]] || skip "to be another user takes root"
  chmod a+x "$scratch"
  mkdir "$scratch/theirs"
  chown "$stranger:$stranger" "$scratch/theirs"
}

# start_theirs NAME [OPTION...]: a node of the other user.
start_theirs() {
  local name=$1
  shift
  inside=(env -u ROSCELL_SITE_TOKEN "HOME=$scratch/theirs" "${inside[@]}"
    setpriv --reuid "$stranger" --regid "$stranger" --clear-groups)
  mkdir -p "$scratch/$name"
  chown "$stranger:$stranger" "$scratch/$name"
  start_node "$name" "$@"
  inside=()
}

start_head() {
  start_node head --coordinator --cell line --interface lo
  server=$(discovery_of head)
}

# expect_alone: nothing has come into head's cell, and nothing runs there.
expect_alone() {
  expect "nodes" "$(get head /v1/cell | jq '.nodes | length')" "${1:-1}"
  expect "instances" "$(get head /v1/instances | jq '.instances | length')" 0
}

test_nodes_of_one_user_meet_without_an_option() {
  start_node arm --interface lo
  grep -q "no site token yet" "$scratch/arm.log" || fail "$(cat "$scratch/arm.log")"
  start_head
  await_joined head arm
  start_node belt --interface lo --join "$server"
  await_joined head belt
  expect "its mode" "$(stat -c %a "$ROSCELL_SITE_TOKEN")" 600
  expect "its folder's" "$(stat -c %a "$(dirname "$ROSCELL_SITE_TOKEN")")" 700
  expect "the socket's folder" "$(stat -c %a "$scratch/head")" 700
  grep -q "site token $ROSCELL_SITE_TOKEN" "$scratch/head.log" \
    || fail "$(cat "$scratch/head.log")"
  "$ROSCELL" doctor --only site-token --to "$scratch/head/node.sock" -o json \
    > "$scratch/found"
  jq -e --arg file "$ROSCELL_SITE_TOKEN" \
    'all(.[]; .verdict == "ok" and (.seen | contains($file)))' "$scratch/found" \
    > /dev/null || fail "$(cat "$scratch/found")"
}

test_another_user_of_this_host_comes_into_no_cell() {
  let_in_strangers
  start_head
  start_theirs thief --interface lo --join "$server"
  await thief '.event == "join_refused"' > "$scratch/refused.json"
  jq -e '.data.reason
    == "node '"'thief'"' has no site token, and cell '"'line'"' wants one"
    and (.data.hint | contains("copy the site token"))' "$scratch/refused.json" \
    > /dev/null || fail "$(cat "$scratch/refused.json")"
  stop_node thief
  # With a token of his own he has a cell of his own.
  start_theirs den --coordinator --cell den --interface lo
  start_theirs thief --interface lo --join "$server"
  await thief '.event == "join_refused"
    and (.data.reason | contains("is not that of node"))' > /dev/null
  as_stranger cat "$ROSCELL_SITE_TOKEN" > /dev/null 2>&1 \
    && fail "everybody can read the site token"
  expect_alone
}

# expect_nothing NODE [PREFIX...]: a program that runs so gets nothing of a node.
expect_nothing() {
  local at
  at=$(get "$1" /v1/node | jq -r .identity.address)
  "${@:2}" /usr/bin/python3 "$scratch/stranger.py" "$at" "$scratch/$1/node.sock" \
    > "$scratch/got" || fail "the stranger: $(cat "$scratch/got")"
  expect "what it gets of $1" "$(jq -r '"\(.tried): \(.got)"' "$scratch/got")" \
    "session: ${session_of[$1]}
registration: ${registration_of[$1]}
registration, proven by nothing: ${registration_of[$1]}
switch: ${registration_of[$1]}
reach: silence
cell: 401 \"unauthorized\"
request: 401 \"unauthorized\"
socket: PermissionError"
}

# A member takes no sessions at all, a coordinator is registered nowhere.
declare -A session_of=([head]=unauthorized [arm]=404)
declare -A registration_of=([head]='404 "unknown_type"' [arm]='401 "unauthorized"')

test_a_program_of_another_user_gets_nothing_from_a_port_of_loopback() {
  let_in_strangers
  start_head
  start_node arm --interface lo --join "$server"
  await_joined head arm
  install -m 755 test/system/scenes/stranger.py "$scratch"
  expect_nothing head as_stranger
  expect_nothing arm as_stranger
  expect_alone 2
}

test_a_data_directory_of_somebody_else_is_not_taken() {
  let_in_strangers
  chmod 1777 "$scratch"
  as_stranger mkdir -m 755 "$scratch/trap" "$scratch/trap/skills"
  as_stranger ln -s "$scratch/precious" "$scratch/trap/lock"
  echo precious > "$scratch/precious"
  timeout "$deadline_s" "$ROSCELL" node --data-dir "$scratch/trap" --interface lo --port 0 \
    2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "the data directory '$scratch/trap' is not taken: it belongs to user" \
    "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  expect "what the link leads to" "$(cat "$scratch/precious")" precious
  expect "what is there" "$(ls "$scratch/trap")" "lock
skills"
  # Where everybody may make a folder, this user may too.
  start_node head --coordinator --cell line --interface lo
}

test_skills_that_somebody_else_may_change_are_told_to_root() {
  let_in_strangers
  chown "$stranger" "$skills/echo"
  start_head
  grep -q "others decide what this node runs as root from $skills: echo: it belongs to user" \
    "$scratch/head.log" || fail "$(cat "$scratch/head.log")"
}

test_a_stranger_with_the_cells_name_keeps_no_coordinator_from_starting() {
  let_in_strangers
  start_theirs den --coordinator --cell line --interface lo
  start_head
  await head '.event == "claim_ignored" and .subject == "den"' > /dev/null
  # Whoever proves that he has the name keeps it.
  timeout "$deadline_s" "$ROSCELL" node --coordinator --cell line --name second --interface lo \
    --data-dir "$scratch/second" --port 0 --discovery-port 0 \
    --public-domain "$public_domain" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "the cell name 'line' is in use: node 'head'" "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
}

# A stranger is nearer than the coordinator that has the name.
test_who_has_the_name_of_a_cell_keeps_it_though_a_stranger_is_heard_first() {
  bridge_hosts 2
  make_site_token
  start_on 2 head --coordinator --cell line
  delay_packets 50
  (umask 077 && rev "$scratch/site.token" > "$scratch/theirs")
  inside=(ip netns exec "${hosts[0]}")
  start_node den --interface 10.231.7.1 --coordinator --cell line \
    --site-token "$scratch/theirs"
  timeout "$deadline_s" ip netns exec "${hosts[0]}" "$ROSCELL" node --coordinator \
    --cell line --name second --interface 10.231.7.1 --data-dir "$scratch/second" \
    --port 0 --discovery-port 0 --public-domain "$public_domain" \
    --site-token "$scratch/site.token" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "the cell name 'line' is in use: node 'head'" "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
}

# comes_through WORD: a line that is given to the task "hello" comes out of it.
comes_through() {
  echo "$1" >> "$scratch/data/hello.in"
  timeout "$deadline_s" grep -m 1 "$1" > "$scratch/came" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/data/hello.out" 2> /dev/null) \
    || fail "'$1' did not come through"
}

test_a_cell_takes_another_site_token_with_no_instance_restarted() {
  start_head
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm
  echo_task hello arm | to head request > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  local before after
  before=$(readlink "$scratch/arm/instances/$instance/pid")
  comes_through one
  head -c 32 /dev/urandom | base64 > "$scratch/fresh"
  chmod 600 "$scratch/fresh"
  mv "$scratch/fresh" "$ROSCELL_SITE_TOKEN"
  local last
  last=$(await head '.event == "node_joined" and .subject == "arm"' | jq .sequence)
  stop_node arm KILL
  start_node arm --interface lo --join "$server" --label place=arm
  await_joined head arm "$last"
  after=$(readlink "$scratch/arm/instances/$instance/pid")
  expect "the program" "$after" "$before"
  comes_through two
}

test_a_copied_site_token_lets_a_node_of_another_host_in() {
  bridge_hosts 2
  inside=(ip netns exec "${hosts[0]}")
  start_node head --coordinator --cell line --interface 10.231.7.1
  inside=(ip netns exec "${hosts[1]}" env "ROSCELL_SITE_TOKEN=$scratch/far/site.token")
  start_node arm --interface 10.231.7.2 --join "$(discovery_of head)"
  inside=()
  await arm '.event == "join_refused"' | jq -e --arg to "$scratch/far/site.token" \
    '.data.hint | contains("coordinator at 10.231.7.1 to '"'"'" + $to + "'"'"'")' \
    > /dev/null || fail "$(cat "$scratch/arm.log")"
  expect_alone
  mkdir "$scratch/far"
  cp -p "$ROSCELL_SITE_TOKEN" "$scratch/far"
  await_joined head arm
}

test_a_coordinator_without_a_place_for_a_site_token_says_so() {
  let_in_strangers
  as_stranger mkdir "$scratch/theirs/data"
  HOME=/nonexistent XDG_CONFIG_HOME= timeout "$deadline_s" env -u ROSCELL_SITE_TOKEN \
    setpriv --reuid "$stranger" --regid "$stranger" --clear-groups \
    "$ROSCELL" node --coordinator --interface lo --port 0 --discovery-port 0 \
    --data-dir "$scratch/theirs/data" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "cannot make the site token '/nonexistent/.config/roscell/site.token'" \
    "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  grep -q "ROSCELL_SITE_TOKEN=FILE" "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
}
