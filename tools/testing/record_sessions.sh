#!/usr/bin/env bash
# Records what the nodes of a small site say to each other, each frame of their
# sessions and some heartbeats: two coordinators, and a member that joins, runs a step,
# stops, comes back, loses its coordinator, is given to the other cell and released.
# What a version has said is kept in test/data, for later ones must understand it.
# Prints a line of JSON a frame; the first has the site's token. Needs root.
# Usage: tools/testing/record_sessions.sh BUILD_DIR > FILE
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/testing/record_sessions.sh BUILD_DIR}"
. tools/bench/on_nodes.sh "$1"
command -v tcpdump > /dev/null || skip "tcpdump is missing"

# say NAME REQUEST: and what is answered goes to nobody but a failure.
say() {
  jq -nc "$2" | to "$1" request > "$scratch/answer.json" \
    || fail "$2: $(cat "$scratch/answer.json")"
}

start_member() {
  start_on 2 arm --join "$(discovery_of hall)" --label place=arm
}

use_skills
make_site_token
http_port=8420
bridge_hosts 3
tcpdump -i "$bridge" -w "$scratch/capture" -U --immediate-mode \
  'tcp port 8420 or (udp and less 58)' 2> "$scratch/tcpdump.log" &
capture=$!
start_on 1 hall --coordinator --cell hall
start_on 3 yard --coordinator --cell yard
start_member
await_joined hall arm
echo_task say arm | to hall request > "$scratch/answer.json" \
  || fail "$(cat "$scratch/answer.json")"
echo hello >> "$scratch/data/say.in"
# Until the step has told what it has done, and heartbeats have passed.
timeout 5 tail -f /dev/null
to hall instances > /dev/null
to hall top --once > /dev/null 2>&1
to hall logs say > /dev/null 2>&1
to hall doctor > /dev/null 2>&1
to arm tasks > /dev/null
stop_node arm
start_member
to hall instances > /dev/null
stop_node hall KILL
start_on 1 hall --coordinator --cell hall
await_joined hall arm
to hall instances > /dev/null
say hall '{type: "task_termination", task: "say"}'
say yard '{type: "node_transfer", node: "arm", target: "yard",
  instances: "refuse"}'
await_joined yard arm
say yard '{type: "node_release", node: "arm", instances: "refuse"}'
stop_node arm
kill "$capture"
wait "$capture" 2> /dev/null
jq -Rc '{site_token: .}' "$scratch/site.token"
python3 tools/testing/read_sessions.py "$scratch/capture"
