# What comes from outside and is wrong: a clear error, nothing changed, and the
# node stays up.

start_alone() {
  start_node head --coordinator --cell line --interface lo
  address=$(get head /v1/node | jq -r .identity.address)
  token=$(cat "$scratch/head/token")
}

# refusal JSON: sends it and prints the error code.
refusal() {
  to head request - <<< "$1" > "$scratch/refusal.json" 2> "$scratch/stderr"
  local code=$?
  [[ $code -eq 1 ]] || fail "exit code $code for: $1"
  jq -r .error.code "$scratch/refusal.json"
}

still_up() {
  expect "health" "$(get head /healthz | jq -r .status)" ok
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}

test_whether_a_node_lives_is_told_to_everybody() {
  start_alone
  expect "by TCP, without a token" "$(curl -sS --max-time "$deadline_s" \
    "http://$address/healthz")" '{"status":"ok"}'
  expect "anything else" "$(curl -sS --max-time "$deadline_s" -o /dev/null \
    -w '%{http_code}' "http://$address/v1/node")" 401
}

test_bad_requests_are_refused_with_their_code() {
  start_alone
  expect "no JSON" "$(refusal '{"type":')" malformed_json
  expect "unknown type" "$(refusal '{"type":"make_coffee"}')" unknown_type
  expect "schema" "$(refusal '{"type":"task_request","task":7}')" \
    schema_violation
  expect "all at once" "$(jq '.error.errors | length' "$scratch/refusal.json")" 2
  expect "a misspelt member" "$(refusal "$(echo_task a \
    | jq -c '.pipeline[0].parameter = {}')")" schema_violation
  expect "what was meant" "$(jq -r .error.message "$scratch/refusal.json" \
    | grep -o 'did you mean .*')" 'did you mean "parameters"?'
  expect "unknown task" \
    "$(refusal '{"type":"task_termination","task":"none"}')" unknown_task
  expect "unknown operation" "$(refusal "$(echo_task a \
    | jq -c '.pipeline[0].operation = "sing"')")" unknown_operation
  expect "unknown model" "$(refusal "$(echo_task a \
    | jq -c '.pipeline[0].model = "opera"')")" unknown_model
  expect "unknown deployment" "$(refusal "$(echo_task a \
    | jq -c '.pipeline[0].deployment = "stage"')")" unknown_deployment
  expect "where" "$(jq -r .error.where "$scratch/refusal.json")" \
    /pipeline/0/deployment
  expect "no room" "$(refusal "$(echo_task a \
    | jq -c '.pipeline[0].labels = {"place": "moon"}')")" no_feasible_allocation
  expect "explained" \
    "$(jq '.error.rejected | length' "$scratch/refusal.json")" 1
  still_up
}

test_what_is_wrong_with_a_request_in_yaml_is_told_with_its_place() {
  start_alone
  expect "a comment" "$(to head request - <<< $'# Who?\ntype: node_query' \
    | jq -r .type)" node_description
  printf '# Where?\ntype: task_query\ncolour: red\n' > "$scratch/task.yaml"
  to head request "$scratch/task.yaml" > "$scratch/refusal.json" \
    2> "$scratch/stderr"
  expect "exit code" $? 1
  expect "code" "$(jq -r .error.code "$scratch/refusal.json")" schema_violation
  grep -q 'task.yaml:3:1: there is no member "colour"' "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
  expect "an anchor" "$(refusal $'a: &x 1\nb: *x')" malformed_json
  grep -q 'standard input:1:4: anchors' "$scratch/stderr" \
    || fail "$(cat "$scratch/stderr")"
  still_up
}

test_a_request_that_is_too_large_or_too_deep_is_refused() {
  start_alone
  head -c 100000000 /dev/zero | tr '\0' ' ' > "$scratch/large"
  expect "100 MB" "$(curl -sS --max-time "$deadline_s" \
    -H "Authorization: Bearer $token" --data-binary @"$scratch/large" \
    -o /dev/null -w '%{http_code}' "http://$address/v1/requests")" 413
  python3 -c 'print("[" * 100000 + "]" * 100000)' > "$scratch/deep"
  expect "depth" "$(refusal "$(cat "$scratch/deep")")" malformed_json
  still_up
}

test_tcp_requests_need_the_bearer_token() {
  start_alone
  expect "no token" "$(curl -sS -o "$scratch/body" -w '%{http_code}' \
    "http://$address/v1/node")" 401
  expect "its code" "$(jq -r .error.code "$scratch/body")" unauthorized
  expect "wrong token" "$(curl -sS -o /dev/null -w '%{http_code}' \
    -H 'Authorization: Bearer nonsense' "http://$address/v1/node")" 401
  expect "right token" "$(curl -sS -o /dev/null -w '%{http_code}' \
    -H "Authorization: Bearer $token" "http://$address/v1/node")" 200
}

test_a_node_raises_its_own_limit_of_descriptors() {
  local hard
  hard=$(ulimit -Hn)
  [[ $hard == unlimited || $hard -gt 1024 ]] \
    || skip "this host lets nobody open more than 1024 files"
  inside=(prlimit --nofile=1024:)
  start_alone
  inside=()
  expect "the soft limit" \
    "$(awk '/Max open files/ {print $4}' "/proc/${pid[head]}/limits")" "$hard"
}

test_a_thousand_silent_connections_lock_nobody_out() {
  start_alone
  python3 - "${address%:*}" "${address#*:}" > "$scratch/crowd" << 'PY' &
import signal, socket, sys
crowd = []
for _ in range(1000):
    s = socket.socket()
    s.settimeout(5)
    try:
        s.connect((sys.argv[1], int(sys.argv[2])))
        crowd.append(s)
    except OSError:
        pass
print(len(crowd), flush=True)
signal.pause()
PY
  crowd=$!
  timeout "$deadline_s" tail -n +1 -f "$scratch/crowd" | head -n 1 > /dev/null
  expect "by TCP" "$(curl -sS --max-time "$deadline_s" -o /dev/null \
    -w '%{http_code}' -H "Authorization: Bearer $token" \
    "http://$address/v1/node")" 200
  still_up
  files=$(ls "/proc/${pid[head]}/fd" | wc -l)
  [[ $files -lt 300 ]] || fail "the node holds $files descriptors"
  kill "$crowd"
}

# trickle HEADER COUNT: so many clients that never come to the end of a request,
# a byte at a time, after this header. Prints "up" once all are at it, and at
# their end each one's reply and the seconds it took.
trickle() {
  python3 - "${address%:*}" "${address#*:}" "$1" "$2" << 'PY'
import select, socket, sys, time
host, port, header, count = sys.argv[1:]
begin = time.monotonic()
slow = []
for _ in range(int(count)):
    s = socket.create_connection((host, int(port)))
    s.sendall(header.encode())
    slow.append(s)
print("up", flush=True)
while slow and time.monotonic() - begin < 40:
    for s in select.select(slow, [], [], 0.5)[0]:
        try:
            reply = s.recv(4096).decode()
        except ConnectionError:
            reply = ""
        print(reply[9:12] or "closed", round(time.monotonic() - begin, 1))
        slow.remove(s)
    for s in slow:
        try:
            s.send(b"x")
        except ConnectionError:
            pass  # Its end is read above.
print("left", len(slow))
PY
}

test_slow_requests_are_ended_and_lock_nobody_out() {
  start_alone
  local kind
  local post="POST /v1/requests HTTP/1.1"$'\r\n'
  trickle "GET /v1/no" 40 > "$scratch/line" &
  trickle "${post}X: " 40 > "$scratch/field" &
  trickle "${post}Authorization: Bearer $token"$'\r\n'"Content-Length: 9999"$'\r\n\r\n' \
    40 > "$scratch/body" &
  for kind in line field body; do
    timeout "$deadline_s" grep -m 1 up > "$scratch/up" \
      < <(exec tail --pid=$$ -n +1 -F "$scratch/$kind" 2> /dev/null) \
      || fail "the clients did not begin"
  done
  expect "by TCP" "$(curl -sS --max-time 2 -o /dev/null -w '%{http_code}' \
    -H "Authorization: Bearer $token" "http://$address/v1/node")" 200
  expect "by the socket" "$(get head /healthz | jq -r .status)" ok
  for kind in line field body; do
    timeout "$deadline_s" grep -m 1 left > "$scratch/left" \
      < <(exec tail --pid=$$ -n +1 -F "$scratch/$kind" 2> /dev/null)
    expect "who is left" "$(cat "$scratch/left")" "left 0"
    expect "ends later than 15 s" \
      "$(awk '$2 > 15 && $1 != "left"' "$scratch/$kind")" ""
  done
  # Unauthenticated peers over the limit are closed without a word.
  expect "replies to those with the token" \
    "$(grep -c '^408' "$scratch/body")" 40
  still_up
}

test_a_request_that_is_cut_off_changes_nothing() {
  start_alone
  echo_task half > "$scratch/task.json"
  python3 - "${address%:*}" "${address#*:}" "$token" "$scratch/task.json" \
    "$scratch/head/node.sock" << 'PY'
import socket, struct, sys
host, port, token, task, path = sys.argv[1:]
body = open(task, "rb").read()
request = (f"POST /v1/requests HTTP/1.1\r\nAuthorization: Bearer {token}\r\n"
           f"Content-Length: {len(body)}\r\n\r\n").encode() + body
for cut in range(1, len(request)):
    if cut % 3 == 0:
        s = socket.socket(socket.AF_UNIX)
        s.connect(path)
    else:
        s = socket.create_connection((host, int(port)))
    if cut % 3 == 1:  # The connection is reset instead of closed.
        s.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    s.sendall(request[:cut])
    s.close()
PY
  expect "the next request" "$(echo_task whole | to head request \
    | jq -r .type)" task_accepted
  expect "tasks" "$(get head /v1/tasks | jq -r '.tasks[].task')" whole
  expect "instances" "$(get head /v1/instances | jq '.instances | length')" 1
}

test_a_port_or_a_data_directory_in_use_is_named() {
  start_alone
  timeout "$deadline_s" "$ROSCELL" node --name other --data-dir "$scratch/other" --interface lo \
    --port "${address#*:}" 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "${address#*:}" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  timeout "$deadline_s" "$ROSCELL" node --name again --data-dir "$scratch/head" --interface lo \
    --port 0 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "$scratch/head" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
}

test_a_wrong_site_token_is_refused_and_told() {
  make_site_token
  start_node head --coordinator --cell line --interface lo \
    --site-token "$scratch/site.token"
  server=$(discovery_of head)
  echo "another-secret-of-enough-length" > "$scratch/wrong.token"
  start_node arm --interface lo --join "$server" \
    --site-token "$scratch/wrong.token"
  await arm '.event == "join_refused"' > "$scratch/refused.json"
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 1
}

# broken_skill SCRIPT: a skill folder whose program is that script.
broken_skill() {
  rm "$skills/echo/bin/echo"
  [[ -z $1 ]] && return
  printf '#!/bin/sh\n%s\n' "$1" > "$skills/echo/bin/echo"
  chmod +x "$skills/echo/bin/echo"
}

test_a_skill_that_exits_at_once_is_told_with_its_code_and_last_lines() {
  broken_skill 'echo "no camera at /dev/video7" >&2; exit 42'
  start_alone
  expect "code" "$(refusal "$(echo_task a)")" engine_failed
  expect "exit code" "$(jq -r .error.exit_code "$scratch/refusal.json")" 42
  jq -r .error.log_tail "$scratch/refusal.json" | has_line 'no camera' \
    || fail "$(cat "$scratch/refusal.json")"
  still_up
  expect "instances" "$(get head /v1/instances | jq '.instances | length')" 0
}

test_a_missing_entry_point_is_named() {
  broken_skill ''
  start_alone
  await head '.event == "skill_refused" and .data.where == "/entry_point/0"
    and (.data.message | contains("bin/echo"))' > /dev/null
  expect "code" "$(refusal "$(echo_task a)")" unknown_operation
  jq -r .error.hint "$scratch/refusal.json" | has_line "$scratch/.*bin/echo" \
    || fail "the hint does not name the program: $(cat "$scratch/refusal.json")"
  still_up
}

test_a_bad_descriptor_is_told_and_the_others_stay() {
  cp -r "$skills/echo" "$skills/bad"
  jq '.models[0].deployments[0].resources.cpu = -1' \
    "$skills/echo/skill.json" > "$skills/bad/skill.json"
  start_alone
  await head '.data.where == "/models/0/deployments/0/resources/cpu"' > /dev/null
  expect "skills" "$(get head /v1/skills | jq '.skills | length')" 1
}

test_if_one_step_fails_the_others_are_rolled_back() {
  cp -r "$skills/echo" "$skills/good"
  jq '.operation = "good"' "$skills/echo/skill.json" > "$skills/good/skill.json"
  broken_skill 'exit 3'
  start_alone
  request=$(echo_task a | jq -c '.pipeline += [.pipeline[0]]
    | .pipeline[0].operation = "good" | .pipeline[1].id = "other"
    | .pipeline[1].output.endpoint += "2"')
  expect "code" "$(refusal "$request")" engine_failed
  jq -r .error.message "$scratch/refusal.json" | has_line "other" \
    || fail "the error does not name the step: $(cat "$scratch/refusal.json")"
  expect "instances" "$(get head /v1/instances | jq '.instances | length')" 0
  still_up
}

test_a_damaged_state_is_refused_and_put_aside_when_told_so() {
  local old instance child
  start_alone
  old=$(get head /v1/node | jq -r .identity.uuid)
  echo_task gone | to head request > "$scratch/reply.json"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  child=$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f3)
  stop_node head KILL
  : > "$scratch/head/state.db"
  timeout 20 "$ROSCELL" node --name head --data-dir "$scratch/head" --interface lo \
    --port 0 --coordinator --discovery-port 0 2> "$scratch/stderr"
  expect "exit code" $? 1
  grep -q "state.db' is damaged" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  grep -q -- --new-identity "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
  kill -0 "$child" || fail "the program has ended with its node"
  start_node head --coordinator --cell line --interface lo --new-identity
  [[ -e $scratch/head/state.db.aside-1 ]] || fail "$(ls "$scratch/head")"
  await head '.event == "stray_ended"' > /dev/null
  timeout "$deadline_s" tail --pid="$child" -f /dev/null \
    || fail "the program of before runs on"
  [[ $(get head /v1/node | jq -r .identity.uuid) != "$old" ]] || fail "the same node"
}
