#!/usr/bin/env bash
# What building costs, without ccache: CPU seconds (user and system) and wall
# seconds of everything that tools/demo.sh needs, from nothing; after touching
# messages/task.hpp; and after touching one actor. One JSON line a figure.
#
#   build_bench.sh [FOLDER]   builds in FOLDER (default build/bench), which is
#                             emptied first; cores: CMAKE_BUILD_PARALLEL_LEVEL
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/bench}
export CCACHE_DISABLE=1
targets=(roscell instance_shim image_source_skill pose_estimation_skill
  render_scenes compare_poses)

# figure NAME COMMAND...: runs it and prints its line.
figure() {
  local name=$1 times
  shift
  times=$( { TIMEFORMAT='%R %U %S'; time "$@" > "$folder.log" 2>&1; } 2>&1 ) \
    || { tail -n 20 "$folder.log" >&2; exit 1; }
  read -r wall user system <<< "$times"
  jq -nc --arg figure "$name" --argjson wall "$wall" --argjson user "$user" \
    --argjson system "$system" --argjson cores "$(nproc)" \
    '{bench: "build", figure: $figure, cpu_s: ($user + $system),
      wall_s: $wall, cores: $cores}'
}

rm -rf "$folder"
cmake --preset release -B "$folder" > /dev/null
build=(cmake --build "$folder" --target "${targets[@]}")
figure from_nothing "${build[@]}"
touch messages/task.hpp
figure after_messages_task "${build[@]}"
touch actors/session/member/member.cpp
figure after_one_actor "${build[@]}"
