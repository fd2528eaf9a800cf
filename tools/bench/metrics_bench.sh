#!/usr/bin/env bash
# Measures how long a scraper of a large cell waits for GET /metrics: at rest,
# and while one node is stopped and does not answer. One JSON line a figure.
# Usage: tools/bench/metrics_bench.sh BUILD_DIR [NODES=50] [EACH=10] [SCRAPES=60]
# EACH is the number of instances on a node.
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/metrics_bench.sh BUILD_DIR [NODES] [EACH] [SCRAPES]}"
nodes=${2:-50}
each=${3:-10}
scrapes=${4:-60}
. tools/bench/on_nodes.sh
use_skills

# It tells its figures as an engine does, every few seconds, and needs nothing of
# the kernel that is scarce for so many on one host, as echo needs inotify.
cat > "$skills/echo/bin/echo" << 'SKILL'
#!/usr/bin/env python3
import os, socket, time
node = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
node.connect(os.environ["NOTIFY_SOCKET"].replace("@", "\0"))
while True:
    node.send(b"READY=1\nWATCHDOG=1\nSTATUS=frames=7 dropped=0 median_us=900"
              b" age_us=33000 times=0,2,3,2,0,0,0,0,0,0,0 times_us=12345")
    time.sleep(4)
SKILL

# scrape: the metrics in metrics.txt; prints how many ms they took.
scrape() {
  curl -sS --max-time 10 --unix-socket "$scratch/head/node.sock" \
    -o "$scratch/metrics.txt" -w '%{time_total}\n' http://node/metrics \
    | jq '. * 1000'
}

# many_steps TASK NODE COUNT: a request with so many echo steps on that node.
many_steps() {
  echo_task "$1" "$2" | jq -c --argjson count "$3" '
    .pipeline = [.pipeline[0] as $step | range($count)
                 | $step + {id: "say\(.)"} | .output.endpoint += "\(.id)"]'
}

# has_told: whether the metrics have the frames of every instance.
has_told() {
  [[ $(grep -c '^roscell_instance_frames_total{.*} 7$' "$scratch/metrics.txt") \
    -eq $((nodes * each)) ]]
}

# measure_scrapes WHAT: one a second.
measure_scrapes() {
  local i
  for ((i = 0; i < scrapes; ++i)); do
    timeout 1 tail -f /dev/null
    scrape
  done > "$scratch/times"
  figure "/metrics, $1: median of $scrapes" "$(median < "$scratch/times")" ms
  figure "/metrics, $1: longest" "$(sort -n "$scratch/times" | tail -n 1)" ms
}

start_node head --coordinator --cell line --interface lo --label place=head
server=$(discovery_of head)
# In a cell they have hosts of their own: here they get what it leaves them.
inside=(nice -n 19)
for ((i = 1; i < nodes; ++i)); do
  start_node "n$i" --interface lo --join "$server" --label "place=n$i"
done
for ((i = 1; i < nodes; ++i)); do
  await_joined head "n$i"
done
for name in "${!pid[@]}"; do
  many_steps "t-$name" "$name" "$each" | to head request > /dev/null \
    || fail "task t-$name was refused"
done
until scrape > /dev/null && has_told; do
  timeout 0.5 tail -f /dev/null
done
figure "nodes" "$nodes" 1
figure "instances" $((nodes * each)) 1
measure_scrapes "at rest"
figure "/metrics, size" "$(wc -c < "$scratch/metrics.txt")" B
kill -STOP "${pid[n1]}"
scrape > "$scratch/times"
figure "/metrics, one node just stopped" "$(cat "$scratch/times")" ms
