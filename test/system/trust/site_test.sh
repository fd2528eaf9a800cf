# A site of identities: who has one gets what his role lets him, and who has none
# gets nothing.

. test/system/scenes/identities.sh

start_arm() {
  start_node arm --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --label place=arm --identity "$scratch/arm.pem"
}

# start_site: head coordinates arm; anna is an operator, wall a viewer.
start_site() {
  make_site hall
  issue coordinator head
  issue node arm
  issue operator anna
  issue viewer wall
  start_node head --coordinator --cell line --interface lo --cpu-floor 1 \
    --identity "$scratch/head.pem"
  start_arm
  await_joined head arm
  where=$(tcp_of head)
}

# as PERSON COMMAND...: by TCP.
as() {
  local person=$1 command=$2
  shift 2
  "$ROSCELL" "$command" --to "$where" --identity "$scratch/$person.pem" "$@"
}

# sniff SECONDS: what passes by TCP on this host meanwhile, into sniffed.
sniff() {
  timeout "$1" python3 -c '
import socket, sys
s = socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(0x0800))
with open(sys.argv[1], "wb", 0) as out:
    while True:
        packet = s.recv(70000)
        if packet[9] == 6:
            out.write(packet)' "$scratch/sniffed"
}

test_two_nodes_with_identities_run_a_task_and_nothing_of_it_is_read_on_the_wire() {
  [[ $(id -u) -eq 0 ]] || skip "to read the wire takes root"
  start_site
  sniff "$deadline_s" &
  local ear=$!
  echo_task secret-of-the-hall arm > "$scratch/task.json"
  as anna run "$scratch/task.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come secret-of-the-hall one
  as wall status > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  grep -q arm "$scratch/out" || fail "$(cat "$scratch/out")"
  # By the Unix socket of a member, too, which its coordinator answers.
  to arm tasks > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  grep -q secret-of-the-hall "$scratch/out" || fail "$(cat "$scratch/out")"
  kill "$ear"
  wait "$ear" 2> /dev/null
  [[ $(stat -c %s "$scratch/sniffed") -gt 5000 ]] || fail "nothing was sniffed"
  local word
  for word in secret-of-the-hall task_request session_hello HTTP/1.1 '"type"'; do
    grep -aqF -- "$word" "$scratch/sniffed" && fail "'$word' passed in clear"
  done
  # The session is one of these connections: after a restart it is another one.
  stop_node arm
  start_arm
  await_joined head arm
  lines_come secret-of-the-hall two
}

test_each_role_gets_its_due_over_tcp_and_a_stranger_nothing() {
  start_site
  echo_task pick arm > "$scratch/task.json"
  as wall run "$scratch/task.json" > "$scratch/out" 2>&1 \
    && fail "a viewer has started a task"
  grep -q "the role 'viewer' may not ask for" "$scratch/out" || fail "$(cat "$scratch/out")"
  as arm status > "$scratch/out" 2>&1 && fail "a node has asked as a person"
  as anna run "$scratch/task.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come pick one
  # A secret crosses the wire, since nobody can read it there.
  printf hunter2 | "$ROSCELL" secret set broker --to "$where" \
    --identity "$scratch/anna.pem" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  expect "secrets" "$(get head /v1/secrets | jq -c '[.secrets[].name]')" '["broker"]'
  printf x | "$ROSCELL" secret set broker --to "$where" \
    --identity "$scratch/wall.pem" > "$scratch/out" 2>&1 && fail "a viewer has set a secret"
  # A stranger: plain, with no identity, and with one of a site of that name.
  curl -s --max-time 5 "http://$where/healthz" > "$scratch/out" 2>&1 \
    && fail "plain: $(cat "$scratch/out")"
  curl -sk --max-time 5 "https://$where/healthz" > "$scratch/out" 2>&1 \
    && fail "nobody: $(cat "$scratch/out")"
  [[ ! -s $scratch/out ]] || fail "a stranger learned: $(cat "$scratch/out")"
  make_site hall other
  issue operator false other
  as false status > "$scratch/out" 2>&1 && fail "of another site: $(cat "$scratch/out")"
  grep -q "is not believed" "$scratch/out" || fail "$(cat "$scratch/out")"
  await head '.event == "session_refused"' > /dev/null
  # A person's curl, by the same file.
  curl -sS --max-time "$deadline_s" -k --cert "$scratch/wall.pem" \
    "https://$where/healthz" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  grep -q '"ok"' "$scratch/out" || fail "$(cat "$scratch/out")"
  lines_come pick two
}

test_who_is_revoked_comes_in_no_more_and_the_others_stay() {
  start_site
  issue node belt
  start_node belt --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --identity "$scratch/belt.pem"
  await_joined head belt
  echo_task pick arm > "$scratch/task.json"
  to head run "$scratch/task.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come pick three
  "$ROSCELL" site revoke belt --dir "$scratch/site" 2> "$scratch/out" \
    || fail "$(cat "$scratch/out")"
  cp "$scratch/site/revoked" "$scratch/head.pem.revoked"
  stop_node belt
  start_node belt --interface lo --join "$(discovery_of head)" --cpu-floor 1 \
    --identity "$scratch/belt.pem"
  await head '.event == "session_refused"
    and (.data.message | contains("was revoked"))' > /dev/null
  # Whom it is about learns it, too.
  await belt 'tojson | contains("identity of this node was refused")' > /dev/null
  expect "nodes" "$(get head /v1/cell | jq '.nodes | length')" 2
  lines_come pick four
}

test_a_skill_is_fetched_and_an_unassigned_node_is_switched_by_identities() {
  start_site
  issue node belt
  issue coordinator side
  # It has no skill of its own: what it runs comes from head, by a permit.
  local given=$skills
  skills=$scratch/none
  mkdir "$skills"
  start_node belt --interface lo --wait --cpu-floor 1 --label place=belt \
    --identity "$scratch/belt.pem"
  skills=$given
  to head form belt > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  await_joined head belt
  "$ROSCELL" skill add "$skills/echo" --to "$scratch/head/node.sock" \
    > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  run_on belt far
  lines_come far one
  # Another coordinator of the site takes it over, by a session of identities.
  start_node side --coordinator --cell side --interface lo --cpu-floor 1 \
    --identity "$scratch/side.pem"
  to head stop far > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  to head transfer belt side > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  await_joined side belt
}
