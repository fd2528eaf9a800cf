#!/usr/bin/env bash
# What identities cost a member beside the token, and what 200 who come each second do to
# a cell of identities in a minute: strangers without a certificate, with one of another
# site of the same name, and with a false invitation while one is open; and an operator
# who is believed, so often. One JSON line a figure; ends with 1 if a bound is broken.
# Usage: tools/bench/unauthenticated_peers_bench.sh BUILD_DIR [SECONDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/bench/on_nodes.sh "${1:?usage: tools/bench/unauthenticated_peers_bench.sh BUILD_DIR [SECONDS]}"
. test/system/scenes/identities.sh
seconds=${2:-60}
most_member_kib=1024
most_grown_kib=2048
settling_s=15

use_skills
make_site hall
make_site hall other
issue coordinator head
issue operator eve other
issue operator anna

start_node plain --coordinator --cell plain --interface lo
start_node guest --join "$(discovery_of plain)" --interface lo
await_joined plain guest
start_node head --coordinator --cell line --interface lo --identity "$scratch/head.pem"
for name in arm belt leg; do
  issue node "$name"
  start_node "$name" --join "$(discovery_of head)" --interface lo \
    --identity "$scratch/$name.pem"
  await_joined head "$name"
done
sleep "$settling_s"

broken=0
more=$(($(memory_kib arm Private_Dirty) - $(memory_kib guest Private_Dirty)))
figure "a member's Private_Dirty with an identity, beyond that with a token" "$more" KiB
((more <= most_member_kib)) || { echo "unauthenticated_peers_bench: a member costs too much" >&2; broken=1; }

# storm WHAT [IDENTITY]
storm() {
  local what=$1 done_ broken_off cpu memory began grown
  cpu=$(cpu_ns head)
  memory=$(memory_kib head Private_Dirty)
  read -r done_ broken_off < <(python3 tools/bench/unauthenticated_peers.py \
    "$(tcp_of head | cut -d: -f2)" 200 "$seconds" "${@:2}")
  figure "handshakes of those $what" "$done_" ""
  figure "handshakes of those $what that were broken off" "$broken_off" ""
  figure "coordinator's CPU meanwhile" "$((($(cpu_ns head) - cpu) / seconds / 10000000))" "%"
  grown=$(($(memory_kib head Private_Dirty) - memory))
  figure "coordinator's Private_Dirty, grown" "$grown" KiB
  ((grown <= most_grown_kib)) || { echo "unauthenticated_peers_bench: it has grown" >&2; broken=1; }
}

storm "without a certificate"
storm "of another site" "$scratch/eve.pem"
"$ROSCELL" site invite --to "$scratch/head/node.sock" > /dev/null 2>&1 \
  || fail "no invitation"
storm "with a false invitation" door
storm "who are believed" "$scratch/anna.pem"
lost=$("$ROSCELL" events --to "$scratch/head/node.sock" --no-follow -o json 2> /dev/null \
  | grep -c '"node_lost"\|"session_lost"')
figure "members lost meanwhile" "$lost" ""
((lost == 0)) || { echo "unauthenticated_peers_bench: a member was lost" >&2; broken=1; }
exit "$broken"
