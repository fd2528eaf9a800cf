#!/usr/bin/env bash
# The dependency law: messages <- actors <- tools, and skills depend on nothing
# else of ours. Checked in the sources and in what the programs load.
# Usage: tools/check_law.sh [BUILD_DIR]
set -uo pipefail
cd "$(dirname "$0")/.."
broken=0

# refuse FOLDER PATTERN: no file of the folder may include what matches.
refuse() {
  if grep -rnE "#include [<\"]($2)" --include='*.hpp' --include='*.cpp' "$1"
  then
    echo "law: $1 must not include any of: $2"
    broken=1
  fi
}

refuse messages 'actors/|schemas/|skills/|tools/|test/'
refuse schemas 'actors/|skills/|tools/|test/'
refuse actors 'skills/|tools/|test/'
refuse actors/edge 'actors/[a-z_]+\.hpp|actors/(allocation|handlers)/|caf/'
refuse actors/allocation 'messages/|schemas/|caf/|nlohmann/|actors/([a-z_]+\.hpp|edge/|handlers/)'
refuse skills 'messages/|schemas/|actors/|tools/|test/|caf/'
refuse tools/instance_shim 'actors/|messages/|schemas/|skills/|caf/'

# loads PROGRAM PATTERN: the program must not need a library that matches.
loads() {
  [[ -x $1 ]] || return 0
  if ldd "$1" 2>/dev/null | grep -E "$2"; then
    echo "law: $1 must not load the above"
    broken=1
  fi
}

if [[ $# -gt 0 ]]; then
  loads "$1/bin/roscell" 'libopencv|libapriltag'
  loads "$1/skills/echo/bin/echo" 'libcaf|libfastrtps|libopencv'
fi

# Waiting is for events; a loop that sleeps wakes an idle robot.
if grep -rnE 'sleep_for|sleep_until|usleep\(' --include='*.?pp' \
     messages schemas actors skills tools; then
  echo "law: nothing sleeps"
  broken=1
fi

[[ $broken -eq 0 ]] && echo "law: kept"
exit $broken
