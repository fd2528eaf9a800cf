#!/usr/bin/env bash
# Whether the memory of nodes grows with what they are asked and do: what only a node
# has (Private_Dirty), before and after each kind of work, and the PSS of what is no
# file. Before that so much of it is done that all that is remembered on purpose is
# full. One JSON line a figure; ends with 1 if a bound is broken. The nodes share the
# loopback of this host. Usage:
# tools/bench/growth_bench.sh BUILD_DIR [--percent N] [KIND...]
#
#   --percent N  so much of what is measured, for a short look (100)
#   KIND         only these: hello strangers instances tasks_list cells post metrics
#                events passed_on changes tasks restarts drains dashboards sessions transfers
set -uo pipefail
cd "$(dirname "$0")/../.."
usage="usage: tools/bench/growth_bench.sh BUILD_DIR [--percent N] [KIND...]"
build=${1:?$usage}
shift
percent=100
kinds=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --percent) percent=${2:?$usage}; shift ;;
    *) kinds+=("$1") ;;
  esac
  shift
done
. tools/bench/on_nodes.sh "$build"
use_skills

# How many of each kind, how many of it before, and how much each may leave in KiB.
queries=20000
first_queries=2000
query_kib=0.05
# A node has whole pages, and an allocator has some more of them now and then.
pages_kib=64
declare -A count=([tasks]=5000 [restarts]=2000 [drains]=2000 [dashboards]=50 [sessions]=500
  [transfers]=500)
declare -A first=([tasks]=1000 [restarts]=1100 [drains]=5000 [dashboards]=10 [sessions]=50
  [transfers]=250)
# Of a dashboard the bound is that of all its questions, and a stream.
declare -A most_kib=([tasks]=0.3 [restarts]=0.3 [drains]=0.3 [dashboards]=1 [sessions]=0.3
  [transfers]=0.3)
all=(hello strangers instances tasks_list cells post metrics events passed_on changes
  tasks restarts drains dashboards sessions transfers)
[[ ${#kinds[@]} -gt 0 ]] || kinds=("${all[@]}")
for kind in "${kinds[@]}"; do
  [[ " ${all[*]} " == *" $kind "* ]] || { echo "$usage" >&2; exit 2; }
done

# part COUNT: so many percent of it; even, and at least two.
part() {
  local n=$(($1 * percent / 100))
  echo $((n < 2 ? 2 : n - n % 2))
}

# No name of a task is used again.
next_task=1

# work KIND COUNT: prints the seconds that it took.
work() {
  if [[ $1 == sessions ]]; then
    join_often "$2"
  else
    python3 tools/bench/growth_load.py "$1" "$2" "$next_task" "$scratch" "$address"
  fi
}

# join_often COUNT: a node that joins and leaves in order.
join_often() {
  local i begin
  begin=$(now_ms)
  for ((i = 0; i < $1; ++i)); do
    start_node guest --interface lo --join "$server" --label place=guest
    await_row active
    stop_node guest
    await_row ''
  done
  jq -n "($(now_ms) - $begin) / 1000"
}

# await_row STATE: of the guest. Events that repeat themselves are not told to who
# comes late.
await_row() {
  local tries=0
  until [[ $(row_state head guest) == "$1" ]]; do
    ((++tries < 1000)) || fail "guest is '$(row_state head guest)', not '$1'"
    timeout 0.02 tail -f /dev/null
  done
}

# What a node has itself, once it is at rest.
rest_s=3
remember() {
  local name kind
  timeout "$rest_s" tail -f /dev/null
  for name in head arm; do
    for kind in Private_Dirty Pss_Anon; do
      was[$name.$kind]=$(memory_kib "$name" "$kind")
    done
  done
}

broken=0
# tell_growth KIND COUNT BOUND NAME
tell_growth() {
  local own each pss
  own=$((${was[$4.Private_Dirty]} - ${before[$4.Private_Dirty]}))
  pss=$((${was[$4.Pss_Anon]} - ${before[$4.Pss_Anon]}))
  each=$(jq -n "$own / $2")
  figure "$1, $4: left by each of $2" "$each" KiB
  figure "$1, $4: Private_Dirty after it" "${was[$4.Private_Dirty]}" KiB
  figure "$1, $4: growth of Pss_Anon" "$pss" KiB
  if [[ $(jq -n "$own > $3 * $2 + $pages_kib") == true ]]; then
    echo "BROKEN: each of $1 leaves more than $3 KiB in $4" >&2
    broken=1
  fi
}

# measure KIND FIRST COUNT BOUND
measure() {
  local kind=$1 first=$2 count=$3 bound=$4 name key seconds
  work "$kind" "$first" > /dev/null || fail "$kind: the first ones"
  next_task=$((next_task + first))
  remember
  for key in "${!was[@]}"; do
    before[$key]=${was[$key]}
  done
  seconds=$(work "$kind" "$count") || fail "$kind"
  next_task=$((next_task + count))
  remember
  figure "$kind: time of each" "$(jq -n "$seconds * 1000 / $count")" ms
  for name in head arm; do
    tell_growth "$kind" "$count" "$bound" "$name"
  done
}

declare -A was=() before=()
start_node head --coordinator --cell alpha --interface lo --label place=head
server=$(discovery_of head)
address=$(get head /v1/cell | jq -r .address)
start_node arm --interface lo --join "$server" --label place=arm
await_joined head arm
mkdir -p "$scratch/data"
touch "$scratch/data/in"
if [[ " ${kinds[*]} " == *" transfers "* ]]; then
  start_node beta --coordinator --cell beta --interface lo --label place=beta
  await head '.event == "peer_joined" and .subject == "beta"' > /dev/null
  start_node rover --interface lo --join "$server" --label place=rover
  await_joined head rover
fi
for kind in "${kinds[@]}"; do
  measure "$kind" "${first[$kind]:-$first_queries}" \
    "$(part "${count[$kind]:-$queries}")" "${most_kib[$kind]:-$query_kib}"
done
exit "$broken"
