#!/usr/bin/env bash
# Measures how a cell bears many members that start at one moment: a coordinator
# and N of them, each alone on a host (network namespaces on one bridge). Time
# until all have joined, and until all are in: the cell's discovery server knows
# each one's own, so that data may flow. The CPU that it takes, then CPU and wire of the
# coordinator and of a member over the minute in which they get to know each
# other and over the one after it, and the memory of both at the end. What is said
# of a member is the median over up to 20 of them. One JSON line a figure. Needs
# root.
# Usage: tools/bench/scale_bench.sh N [--binary-dir BUILD_DIR]
set -uo pipefail
cd "$(dirname "$0")/../.."
usage="usage: tools/bench/scale_bench.sh N [--binary-dir BUILD_DIR]"
members=
build=build/release
while [[ $# -gt 0 ]]; do
  case $1 in
    --binary-dir) build=${2:?$usage}; shift ;;
    *) members=$1 ;;
  esac
  shift
done
# The hosts' addresses are those of one /24, and one is the coordinator's.
[[ $members =~ ^[0-9]+$ && $members -ge 1 && $members -le 253 ]] \
  || { echo "$usage, of 1 to 253 members" >&2; exit 2; }

. tools/bench/on_nodes.sh "$build"
. tools/bench/idle_nodes.sh
span_s=60
all_in_s=300
most_sampled=20

# launch I: a member on host I, which waits for the gate, so that all start at
# one moment whatever it takes to make so many processes.
launch() {
  local name=node$1
  ip netns exec "${hosts[$1 - 1]}" flock --no-fork -s "$scratch/gate" \
    "$ROSCELL" node --name "$name" --data-dir "$scratch/$name" \
    --interface "10.231.7.$1" --site-token "$scratch/site.token" \
    --skills "$skills" --public-domain "$public_domain" --runtime process \
    --join "$server" 2> "$scratch/$name.log" &
  pid[$name]=$!
  echo "${pid[$name]}" >> "$scratch/pids"
}

# await_members: until the coordinator has told of each of them.
await_members() {
  local end=$((SECONDS + all_in_s)) name joined reader
  local -A in=()
  exec {joined}< <(exec "$ROSCELL" events --to "$scratch/head/node.sock" \
    --since 0 -o json 2> "$scratch/events.err" \
    | jq --unbuffered -r 'select(.event == "node_joined") | .subject')
  reader=$!
  while [[ ${#in[@]} -lt $members && $SECONDS -lt $end ]] \
    && read -r -t $((end - SECONDS)) name <&"$joined"; do
    in[$name]=yes
  done
  kill "$reader" 2> /dev/null
  exec {joined}<&-
  [[ ${#in[@]} -eq $members ]] \
    || fail "${#in[@]} of $members are in after $all_in_s s"
}

# known_servers: "told", and then how many of them the cell's discovery server
# knows; "told" alone where that is of an earlier version, which does not tell;
# nothing where the answer is that there is none.
known_servers() {
  curl -sS --unix-socket "$scratch/head/node.sock" http://node/metrics \
    | sed -n 's/^roscell_build_info.*/told/p
              s/^roscell_discovery_participants{kind="server"}//p' \
    | tr -d '\n'
}

# await_servers: until it knows that of each member; false: it does not tell.
await_servers() {
  local end=$((SECONDS + all_in_s)) known
  until known=$(known_servers) && [[ $known == "told $members" ]]; do
    [[ $known != told ]] || return 1
    [[ $SECONDS -lt $end ]] \
      || fail "discovery does not know all of $members after $all_in_s s"
    timeout 0.05 tail -f /dev/null
  done
  return 0
}

# cpu_s_of NAME...: CPU time of all of these.
cpu_s_of() {
  local name
  for name in "$@"; do
    cat /proc/"${pid[$name]}"/task/*/schedstat
  done | awk '{sum += $1} END {printf "%.2f", sum / 1e9}'
}

# wire_of I DIRECTION: bytes that host I has sent or received, read at the
# bridge's end of its cable, where that costs no process in its namespace.
wire_of() {
  local -A counter=([sent]=rx_bytes [received]=tx_bytes)
  cat "/sys/class/net/$(host_link "$1")/statistics/${counter[$2]}"
}

# counters_of I NAME: what grows, in one line.
counters_of() {
  echo "$(cpu_ns "$2") $(wire_of "$1" sent) $(wire_of "$1" received)"
}

# growth BEFORE AFTER COLUMN PER: of one of the counters, per second and PER.
growth() {
  jq -n "$(cut -d' ' -f"$3" <<< "$2") - $(cut -d' ' -f"$3" <<< "$1")
    | . / $4 / $span_s"
}

# coordinator_rates WHEN BEFORE AFTER: of the coordinator, whole and for each
# member.
coordinator_rates() {
  local of="coordinator, $1" cpu sent received
  cpu=$(growth "$2" "$3" 1 1e7)
  sent=$(growth "$2" "$3" 2 1)
  received=$(growth "$2" "$3" 3 1)
  figure "$of: CPU" "$cpu" "% of a core"
  figure "$of: CPU, a member" "$(jq -n "$cpu / $members")" "% of a core"
  figure "$of: wire, sent" "$sent" B/s
  figure "$of: wire, received" "$received" B/s
  figure "$of: wire, sent, a member" "$(jq -n "$sent / $members")" B/s
  figure "$of: wire, received, a member" "$(jq -n "$received / $members")" B/s
}

# member_rate WHEN NAME COLUMN PER UNIT: the median over the sampled members.
member_rate() {
  local i
  figure "member, $1: $2" "$(for i in "${sampled[@]}"; do
    growth "${before[$i]}" "${after[$i]}" "$3" "$4"
  done | median)" "$5"
}

pss_mib() {
  jq -n "$(memory_kib "$1" Pss) / 1024"
}

# All hosts share one kernel's table of neighbours, which two entries for each of 250
# members overflow at times: then single hosts reach nobody for half a minute.
neighbours=/proc/sys/net/ipv4/neigh/default/gc_thresh
before_bench=("$(< ${neighbours}1)" "$(< ${neighbours}2)" "$(< ${neighbours}3)")
set_neighbours() {
  echo "$3" > ${neighbours}3
  echo "$2" > ${neighbours}2
  echo "$1" > ${neighbours}1
}
trap 'set_neighbours "${before_bench[@]}"; clean_up 2> /dev/null; rm -rf "$scratch"' EXIT
set_neighbours 4096 8192 16384

skills=$scratch/skills
mkdir "$skills"
bridge_hosts $((members + 1))
make_site_token
start_on 1 head --coordinator --cell line
server=$(discovery_of head)
exec {gate}> "$scratch/gate"
flock -x "$gate"
names=()
for ((i = 2; i <= members + 1; ++i)); do
  launch "$i"
  names+=("node$i")
done
head_cpu=$(cpu_s_of head)
begin=$(now_ms)
flock -u "$gate"
await_members
figure "members: all of $members have joined" $(($(now_ms) - begin)) ms
await_servers \
  && figure "members: all of $members in" $(($(now_ms) - begin)) ms
figure "members: CPU of all starts" "$(cpu_s_of "${names[@]}")" s
figure "coordinator: CPU until all are in" \
  "$(jq -n "$(cpu_s_of head) - $head_cpu")" s

sampled=()
for ((i = 2; i <= members + 1; i += (members + most_sampled - 1) / most_sampled)); do
  sampled+=("$i")
done
# span WHEN: what the coordinator and the members take meanwhile.
span() {
  local i
  local -A before after
  before[1]=$(counters_of 1 head)
  for i in "${sampled[@]}"; do before[$i]=$(counters_of "$i" "node$i"); done
  timeout "$span_s" tail -f /dev/null
  after[1]=$(counters_of 1 head)
  for i in "${sampled[@]}"; do after[$i]=$(counters_of "$i" "node$i"); done
  coordinator_rates "$1" "${before[1]}" "${after[1]}"
  member_rate "$1" CPU 1 1e7 "% of a core"
  member_rate "$1" "wire, sent" 2 1 B/s
  member_rate "$1" "wire, received" 3 1 B/s
}

span "first minute"
span "second minute"
figure "coordinator: Pss" "$(pss_mib head)" MiB
figure "member: Pss" "$(for i in "${sampled[@]}"; do pss_mib "node$i"; done \
  | median)" MiB
