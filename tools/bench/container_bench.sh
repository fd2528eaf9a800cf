#!/usr/bin/env bash
# Measures how long a skill in a container takes from request to running, with a
# cached image, beside the engine's own create + start of the same image in the
# same run, and tells the sizes of the images. One JSON line a figure. Needs root.
# Usage: tools/bench/container_bench.sh BUILD_DIR [ROUNDS]
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/bench/container_bench.sh BUILD_DIR [ROUNDS]}"
rounds=${2:-7}
. tools/bench/on_nodes.sh
engine_dir=$scratch/engine
base_tar=$ROSCELL_BUILD/../base-images/bookworm.tar
. tools/own_engine.sh
trap 'clean_up 2> /dev/null; stop_engine; rm -rf "$scratch"' EXIT
use_skills
start_engine || { cat "$engine_dir.reason"; exit 1; }
runtime=docker:$engine_socket
start_node head --coordinator --cell line --interface lo

run_task() {
  echo_task "$1" > "$scratch/task.json"
  local begin
  begin=$(now_ms)
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || { cat "$scratch/reply.json" >&2; exit 1; }
  echo $(($(now_ms) - begin))
}

end_task() {
  echo "{\"type\": \"task_termination\", \"task\": \"$1\"}" \
    | to head request > /dev/null
}

api() {
  curl -sS --fail --unix-socket "$engine_socket" -X POST \
    -H 'Content-Type: application/json' "http://engine$1" "${@:2}"
}

# The engine's own create + start of that image, by its API.
engine_alone() {
  local begin id
  begin=$(now_ms)
  id=$(api /containers/create -d "{\"Image\": \"$1\", \"Cmd\": [\"sleep\", \"60\"],
    \"HostConfig\": {\"NetworkMode\": \"host\", \"IpcMode\": \"host\"}}" | jq -r .Id)
  api "/containers/$id/start"
  echo $(($(now_ms) - begin))
  engine rm -f "$id" > /dev/null
}

figure "request to running, image built in it" "$(run_task first)" ms
end_task first
image=$(engine images --format '{{.Repository}}:{{.Tag}}' | grep -m 1 ^roscell/)
for ((i = 0; i < rounds; ++i)); do
  run_task "round$i" >> "$scratch/ours"
  end_task "round$i"
  engine_alone "$image" >> "$scratch/theirs"
done
ours=$(median < "$scratch/ours") theirs=$(median < "$scratch/theirs")
figure "request to running, cached image, median of $rounds" "$ours" ms
figure "engine's own create + start, median of $rounds" "$theirs" ms
figure "ratio" "$(jq -n "$ours / $theirs")" ""
engine images --format '{{.Repository}} {{.ID}}' | while read -r name id; do
  figure "size of $name, base included" \
    "$(engine image inspect "$id" --format '{{.Size}}' | jq '. / 1e6')" MB
done
