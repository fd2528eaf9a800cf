#!/usr/bin/env bash
# What building costs, without ccache: CPU seconds (user and system) and wall seconds,
# and how many sources were compiled, of everything that tools/demo.sh needs: from
# nothing, and after touching what is changed most often: a package's limits, a header
# that has a message's fields, one actor. One JSON line a figure.
#
#   build_bench.sh [FOLDER]   builds in FOLDER (default build/bench), which is
#                             emptied first; cores: CMAKE_BUILD_PARALLEL_LEVEL
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/bench}
export CCACHE_DISABLE=1
targets=(roscell instance_shim image_source_skill pose_estimation_skill
  render_scenes compare_poses)

# figure NAME: builds, and prints its line.
figure() {
  local times wall user system
  times=$( { TIMEFORMAT='%R %U %S'
    time cmake --build "$folder" --target "${targets[@]}" > "$folder.log" 2>&1; } 2>&1 ) \
    || { tail -n 20 "$folder.log" >&2; exit 1; }
  read -r wall user system <<< "$times"
  jq -nc --arg figure "$1" --argjson wall "$wall" --argjson user "$user" \
    --argjson system "$system" --argjson cores "$(nproc)" \
    --argjson compiled "$(grep -cE '^\[.*Building C(XX)? object' "$folder.log" || true)" \
    '{bench: "build", $figure, cpu_s: ($user + $system), wall_s: $wall, $compiled, $cores}'
}

# figure_after FILE: as if it had been changed. It gets its time back, so that other
# build folders of this tree do not build for it.
figure_after() {
  touch -r "$1" "$folder.time"
  touch "$1"
  figure "after touching $1"
  touch -r "$folder.time" "$1"
}

rm -rf "$folder"
cmake --preset release -B "$folder" > /dev/null
figure "from nothing"
for file in actors/edge/session/limits.hpp messages/task.hpp \
  actors/session/member/member.cpp; do
  figure_after "$file"
done
rm "$folder.time"
