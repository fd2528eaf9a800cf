#!/usr/bin/env bash
# The paper's tables of overhead: what a cell costs that has nothing to do, and what
# starting costs. One JSON line a figure. Needs root. Parts, all of them if none is
# named:
#
#   cell        a coordinator and its members, each alone on a host (network namespaces
#               on one bridge), a new cell for each round. The members start at one
#               moment: how long until all have joined, and until all are in, that is
#               the discovery server knows each one's own, so that data may flow; the
#               CPU of that. After REST seconds the counters are read, and SECONDS later
#               again: CPU time of all threads (schedstat), bytes written to the disk
#               (/proc/PID/io), bytes and packets at the bridge's end of the host's
#               cable; then the memory. At the end starts of single nodes and of a task.
#               A figure is the median over rounds and, of a member, over up to 20 of
#               them, with the least and the most beside it.
#   containers  request to running as a container beside the engine's own create and
#               start of the same image, in turns; sizes of the images
#   size        of programs, light skills and their libraries, stripped
#
# Where the paper rotates devices, rounds are repeated: all hosts here are one machine,
# so its other load must be small.
# Usage: tools/bench/overhead_bench.sh BUILD_DIR [--members N] [--rest S] [--seconds S]
#        [--rounds N] [PART...]
set -uo pipefail
cd "$(dirname "$0")/../.."
usage="usage: tools/bench/overhead_bench.sh BUILD_DIR [--members N] [--rest S]
  [--seconds S] [--rounds N] [cell | containers | size]..."
refuse() {
  echo "$*" >&2
  exit 2
}
build=${1:?$usage}
shift
members=5 rest_s=15 span_s=60 rounds=1 parts=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --members) members=${2:?$usage}; shift ;;
    --rest) rest_s=${2:?$usage}; shift ;;
    --seconds) span_s=${2:?$usage}; shift ;;
    --rounds) rounds=${2:?$usage}; shift ;;
    cell | containers | size) parts+=("$1") ;;
    *) refuse "$usage" ;;
  esac
  shift
done
# The hosts' addresses are those of one /24; one is the coordinator's, and one is of
# those that start alone.
[[ $members =~ ^[0-9]+$ && $members -ge 1 && $members -le 252 ]] \
  || refuse "$usage, of 1 to 252 members"
[[ ${#parts[@]} -gt 0 ]] || parts=(cell containers size)
turns=7

# run_task NAME TASK: milliseconds from request to running, the client's start
# included. It ends then.
run_task() {
  local begin
  echo_task "$2" > "$scratch/task.json"
  begin=$(now_ms)
  to "$1" request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  echo $(($(now_ms) - begin))
  end_task "$1" "$2"
}

end_task() {
  echo "{\"type\": \"task_termination\", \"task\": \"$2\"}" | to "$1" request > /dev/null
}

engine_api() {
  curl -sS --fail --unix-socket "$engine_socket" -X POST \
    -H 'Content-Type: application/json' "http://engine$1" "${@:2}"
}

# engine_alone IMAGE: milliseconds of its own create and start.
engine_alone() {
  local begin id
  begin=$(now_ms)
  id=$(engine_api /containers/create -d "{\"Image\": \"$1\", \"Cmd\": [\"sleep\", \"60\"],
    \"HostConfig\": {\"NetworkMode\": \"host\", \"IpcMode\": \"host\"}}" | jq -r .Id)
  engine_api "/containers/$id/start"
  echo $(($(now_ms) - begin))
  engine rm -f "$id" > /dev/null
}

containers_part() {
  local image turn name id ours theirs
  engine_dir=$scratch/engine
  base_tar=$ROSCELL_BUILD/../base-images/bookworm.tar
  . tools/own_engine.sh
  trap 'clean_up 2> /dev/null; stop_engine; rm -rf "$scratch"' EXIT
  use_skills
  start_engine || skip "$(cat "$engine_dir.reason")"
  runtime=docker:$engine_socket
  start_node head --coordinator --cell line --interface lo
  figure "request to running, image built in it" "$(run_task head first)" ms
  image=$(engine images --format '{{.Repository}}:{{.Tag}}' | grep -m 1 ^roscell/)
  for ((turn = 1; turn <= turns; ++turn)); do
    run_task head "turn$turn" >> "$scratch/ours"
    engine_alone "$image" >> "$scratch/theirs"
  done
  ours=$(median < "$scratch/ours") theirs=$(median < "$scratch/theirs")
  figure "request to running, cached image: median of $turns" "$ours" ms
  figure "the engine's own create and start: median of $turns" "$theirs" ms
  figure "cached image, ratio" "$(jq -n "$ours / $theirs")" ""
  engine images --format '{{.Repository}} {{.ID}}' | while read -r name id; do
    figure "size of $name, base included" \
      "$(engine image inspect "$id" --format '{{.Size}}' | jq '. / 1e6')" MB
  done
}

size_part() {
  tools/launch/pack.sh "$ROSCELL_BUILD" "$scratch/packed"
  figure "programs, light skills and their libraries" \
    "$(jq -n "$(du -sk "$scratch/packed" | cut -f 1) / 1024")" MiB
}

failed=0
for part in "${parts[@]}"; do
  (
    . tools/bench/on_nodes.sh "$build"
    . tools/bench/idle_cell.sh
    "${part}_part"
  ) || failed=$?
done
exit "$failed"
