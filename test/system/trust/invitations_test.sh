# How machines and people come to their identities: by invitations, by a cell that
# adopts a site, by renewal; and how they lose them.

. test/system/scenes/identities.sh

# on_machine N NAME [OPTION...]: a node on one of the hosts, as a user starts it.
on_machine() {
  local number=$1 name=$2
  shift 2
  inside=(ip netns exec "${hosts[$((number - 1))]}")
  start_node "$name" --interface "10.231.7.$number" --cpu-floor 1 \
    --label "place=$name" "$@"
  inside=()
}

# below NAME COMMAND SUBCOMMAND...: a client command of two words, spoken to that node.
below() {
  "$ROSCELL" "$2" "$3" --to "$scratch/$1/node.sock" "${@:4}"
}

# start_head [OPTION...]: a coordinator on the machine that keeps the site, which
# gives it an identity.
start_head() {
  make_site hall head/site
  start_node head --coordinator --cell line --interface lo --cpu-floor 1 "$@"
  where=$(tcp_of head)
}

# invite ROLE [NAME]: into NAME.invitation, or that of the role.
invite() {
  below head site invite "$@" --dir "$scratch/head/site" \
    > "$scratch/${2:-$1}.invitation" 2> "$scratch/out" || fail "$(cat "$scratch/out")"
}

# start_invited NAME: a node of head's cell that comes by an invitation.
start_invited() {
  invite node "$1"
  start_node "$1" --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label "place=$1" --invite "$scratch/$1.invitation"
  await_joined head "$1"
}

# start_again NAME: the same, once it has its identity.
start_again() {
  start_node "$1" --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label "place=$1"
}

# log_has NAME COUNT PATTERN: waits until so many lines of a node's log are so.
log_has() {
  timeout "$deadline_s" grep -m "$2" "$3" > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/$1.log" 2> /dev/null) \
    || fail "no '$3' in the log of $1: $(tail -n 5 "$scratch/$1.log")"
}

test_two_empty_machines_are_one_cell_after_four_commands() {
  need_namespaces
  bridge_hosts 2
  local begun=$EPOCHSECONDS
  make_site hall head/site                                            # 1
  on_machine 1 head --coordinator --cell line                         # 2
  invite node                                                         # 3
  on_machine 2 arm --invite "$(cat "$scratch/node.invitation")"       # 4
  await_joined head arm
  echo "    two machines are one cell after $((EPOCHSECONDS - begun)) s"
  [[ $((EPOCHSECONDS - begun)) -le 60 ]] || fail "it took longer than a minute"
  run_on arm pick
  lines_come pick one
  # Started again in the same way, the node does not need the invitation again.
  stop_node arm
  on_machine 2 arm --invite "$(cat "$scratch/node.invitation")"
  lines_come pick two
  # Another one gets nothing by it.
  ip netns exec "${hosts[1]}" "$ROSCELL" node --name belt --interface 10.231.7.2 \
    --data-dir "$scratch/belt" --port 0 --invite "$scratch/node.invitation" \
    > "$scratch/out" 2>&1 && fail "an invitation was used twice"
  grep -q "was used, or is over" "$scratch/out" || fail "$(cat "$scratch/out")"
  [[ ! -e $scratch/belt/identity.pem ]] || fail "it has got an identity"
  # Nor does anybody become arm by an invitation that does not say so.
  invite node
  ip netns exec "${hosts[1]}" "$ROSCELL" node --name arm --interface 10.231.7.2 \
    --data-dir "$scratch/false" --port 0 --invite "$scratch/node.invitation" \
    > "$scratch/out" 2>&1 && fail "somebody else is arm now"
  grep -q "there has been a node 'arm'" "$scratch/out" || fail "$(cat "$scratch/out")"
  lines_come pick three
}

test_a_cell_with_a_token_adopts_identities_and_no_instance_is_restarted() {
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  start_node arm --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label place=arm
  await_joined head arm
  run_on arm pick
  lines_come pick one
  local before after
  before=$(get arm /v1/instances | jq -c '[.instances[] | [.instance, .pid, .restarts]]')
  make_site hall
  below head site adopt --dir "$scratch/site" 2> "$scratch/out" || fail "$(cat "$scratch/out")"
  grep -q "2 nodes; tokens count no more" "$scratch/out" || fail "$(cat "$scratch/out")"
  log_has head 1 "is made anew"
  log_has arm 1 "is made anew"
  log_has arm 2 "joined cell"
  lines_come pick two
  after=$(get arm /v1/instances | jq -c '[.instances[] | [.instance, .pid, .restarts]]')
  expect "instances" "$after" "$before"
  expect "trust" "$(echo '{"type":"site_query","node":"arm"}' \
    | to head request - | jq -r .trust)" identity
  # Whoever has only the token is nobody now.
  curl -s --max-time 5 "http://$(tcp_of head)/healthz" > "$scratch/out" 2>&1 \
    && fail "plain: $(cat "$scratch/out")"
  start_node belt --interface lo --join "$(discovery_of head)" --cpu-floor 1
  log_has belt 1 "as a site of identities does to who has a token"
  expect "nodes" "$(get head /v1/cell | jq '.nodes | length')" 2
  # A restart, and the same again by renewals.
  stop_node arm
  start_again arm
  lines_come pick three
  below head site renew --all --dir "$scratch/site" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  lines_come pick four
}

test_a_cell_takes_another_key_of_its_site_and_the_old_one_counts_no_more() {
  start_head
  start_invited arm
  run_on arm pick
  lines_come pick one
  issue operator anna head/site
  below head site rotate --dir "$scratch/head/site" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  log_has arm 2 "joined cell"
  lines_come pick two
  "$ROSCELL" status --to "$(tcp_of head)" --identity "$scratch/anna.pem" \
    > "$scratch/out" 2>&1 && fail "the old key still counts"
  stop_node arm
  start_again arm
  lines_come pick three
}

test_the_session_of_who_is_revoked_ends_and_data_of_the_others_flow() {
  start_head
  local name
  for name in arm belt leg; do start_invited "$name"; done
  run_on arm pick
  lines_come pick one
  below head site revoke belt --dir "$scratch/head/site" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  await head '.event == "node_lost" and .subject == "belt"' > "$scratch/belt.lost"
  await head '.event == "request_received" and .subject == "head"
    and .data.request == "revocation_setting"' > "$scratch/taken"
  local ms
  ms=$(($(jq .time_unix_ms "$scratch/belt.lost") - $(jq .time_unix_ms "$scratch/taken")))
  echo "    its session ended after $ms ms"
  [[ $ms -le 1000 ]] || fail "its session ended only after $ms ms"
  await head '.event == "session_refused"
    and (.data.message | contains("was revoked"))' > /dev/null
  # One that is away when that happens.
  stop_node leg
  below head site revoke leg --dir "$scratch/head/site" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  start_again leg
  await leg 'tojson | contains("certificate revoked")' > /dev/null
  # The other member has the list, too.
  await arm '.event == "revocations_taken"' > /dev/null
  lines_come pick two
  stop_node arm
  start_again arm
  lines_come pick three
}

test_a_certificate_that_has_ended_while_its_node_was_off_is_renewed() {
  make_site hall head/site
  "$ROSCELL" site issue node arm --dir "$scratch/head/site" --good-for 1s \
    --out "$scratch/arm.pem" 2> "$scratch/out" || fail "$(cat "$scratch/out")"
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  # The node's season in a cupboard.
  timeout 2 tail -f /dev/null
  start_node arm --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label place=arm --identity "$scratch/arm.pem"
  await arm '.event == "identity_taken"' > /dev/null
  await_joined head arm
  run_on arm pick
  lines_come pick one
  stop_node arm
  start_node arm --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label place=arm --identity "$scratch/arm.pem"
  lines_come pick two
}

test_people_log_in_by_an_invitation_and_what_they_change_is_written_down() {
  export XDG_CONFIG_HOME=$scratch/config
  start_head
  invite operator anna
  invite viewer wall
  "$ROSCELL" login --invite "$scratch/anna.invitation" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  expect "mode" "$(stat -c %a "$XDG_CONFIG_HOME/roscell/logins/$where.pem")" 600
  echo_task pick > "$scratch/task.json"
  "$ROSCELL" run "$scratch/task.json" --to "$where" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  lines_come pick one
  # Another person on another account.
  XDG_CONFIG_HOME=$scratch/other "$ROSCELL" login --invite "$scratch/wall.invitation" \
    2> "$scratch/out" || fail "$(cat "$scratch/out")"
  XDG_CONFIG_HOME=$scratch/other "$ROSCELL" stop pick --to "$where" \
    > "$scratch/out" 2>&1 && fail "a viewer has stopped a task"
  to head audit -o json > "$scratch/audit" || fail "the audit is not whole"
  expect "of anna" "$(jq '[.records[] | select(.from | startswith("operator anna at "))
    | select(.request == "task_request" and .outcome == "done")] | length' \
    "$scratch/audit")" 1
  expect "of wall" "$(jq '[.records[] | select(.from | startswith("viewer wall at "))
    | select(.outcome == "unauthorized")] | length' "$scratch/audit")" 1
  sed -i 's/viewer wall/viewer ball/' "$scratch/head/audit/audit"
  to head audit > "$scratch/out" 2>&1 && fail "an altered record was not seen"
  grep -q "was altered" "$scratch/out" || fail "$(cat "$scratch/out")"
  # An invitation is good once, also for people.
  "$ROSCELL" login --invite "$scratch/anna.invitation" > "$scratch/out" 2>&1 \
    && fail "an invitation was used twice"
  lines_come pick two
}

test_a_secret_of_a_cell_reaches_all_of_its_nodes_by_identities_only() {
  start_head
  start_invited arm
  printf hunter2 | below head secret set broker --cell 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  local name
  for name in head arm; do
    expect "secrets of $name" "$(get "$name" /v1/secrets \
      | jq -c '[.secrets[].name]')" '["broker"]'
  done
  # A cell with a token does not: anybody could read it on its way.
  start_node side --coordinator --cell side --interface lo --cpu-floor 1 \
    --site-token "$(make_site_token; echo "$scratch/site.token")"
  start_node belt --interface lo --join "$(discovery_of side)" --cpu-floor 1 \
    --site-token "$scratch/site.token"
  await_joined side belt
  printf hunter2 | below side secret set broker --node belt > "$scratch/out" 2>&1 \
    && fail "a secret crossed the network in clear"
  grep -q "in clear" "$scratch/out" || fail "$(cat "$scratch/out")"
}

test_a_cell_that_asks_for_signatures_runs_what_an_operator_has_signed() {
  start_head --require-signed-skills
  start_invited arm
  issue operator anna head/site
  issue viewer wall head/site
  # It lies on each node, and nobody has signed it.
  echo_task pick arm > "$scratch/task.json"
  to head run "$scratch/task.json" > "$scratch/out" 2>&1 && fail "an unsigned skill runs"
  cp -r "$skills/echo" "$scratch/shared"
  below head skill add "$scratch/shared" > "$scratch/out" 2>&1 \
    && fail "an unsigned skill was added"
  grep -q "an operator has signed" "$scratch/out" || fail "$(cat "$scratch/out")"
  "$ROSCELL" skill sign "$scratch/shared" --identity "$scratch/wall.pem" \
    > "$scratch/out" 2>&1 && fail "a viewer signs"
  "$ROSCELL" skill sign "$scratch/shared" --identity "$scratch/anna.pem" \
    2> "$scratch/out" || fail "$(cat "$scratch/out")"
  below head skill add "$scratch/shared" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  to head run "$scratch/task.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come pick one
  # Another build has another hash.
  echo >> "$scratch/shared/skill.json"
  below head skill add "$scratch/shared" > "$scratch/out" 2>&1 \
    && fail "a signature of another build counts"
  lines_come pick two
}
