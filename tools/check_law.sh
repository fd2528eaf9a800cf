#!/usr/bin/env bash
# The dependency law: messages <- actors <- tools; dds is shared by actors and
# skills, which depend on nothing else of ours but the public headers in
# include, which depend on nothing of ours; inside actors edge <- core <- session, instances, placement <-
# builds (which knows instances) <- cell, membership <- requests <- node. Checked in the sources and in what the
# programs load; and that no folder is crowded.
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

# Who embeds us sees these headers and no other of ours, and of other libraries
# only what they cannot do without: a skill's author no actor system.
refuse include 'actors/|dds/|messages/|schemas/|skills/|tools/|test/|nlohmann/|valijson/|boost/|fastdds/|fastrtps/|spdlog/|CLI/'
refuse include/roscell/skill 'roscell/([^s]|skill\.hpp)|caf/|fastcdr/'
refuse include/roscell/ros2 'roscell/(ros2\.hpp|[^rs])|caf/'
refuse dds 'messages/|actors/|schemas/|skills/|tools/|test/|caf/'
refuse messages 'dds/|actors/|schemas/|skills/|tools/|test/'
refuse schemas 'actors/|skills/|tools/|test/'
refuse actors 'skills/|roscell/(skill|ros2)|tools/|test/'
# The edge knows no actor.
packages='session|instances|placement|builds|cell|membership|requests|node'
refuse actors/edge "caf/|actors/($packages)/|actors/core/|actors/precompiled"
refuse actors/core "actors/($packages)/"
refuse actors/session 'actors/(instances|placement|cell|membership|requests|node)/'
refuse actors/instances 'actors/(session|placement|builds|cell|membership|requests|node)/'
refuse actors/placement 'actors/(session|instances|builds|cell|membership|requests|node)/'
refuse actors/builds 'actors/(session|placement|cell|membership|requests|node)/'
refuse actors/cell 'actors/(instances|membership|requests|node)/'
refuse actors/membership 'actors/(instances|placement|cell|requests|node)/'
refuse actors/requests 'actors/(session|instances|cell|membership|node)/'
refuse actors/cell/tables 'actors/(session|placement|edge)/|caf/(all|.*actor_system)'
refuse actors/placement/search 'messages/|schemas/|caf/|nlohmann/|actors/(core|edge|session|instances|cell|membership|requests|node)/|actors/placement/[a-z_]+\.hpp'
refuse skills 'messages/|schemas/|actors/|tools/|test/|caf/'
refuse embedding 'client/|tools/|test/'
refuse client 'embedding/|skills/|tools/|test/|actors/[a-df-z]'
refuse tools/render_scenes 'skills/|actors/'
refuse tools/compare_poses 'skills/|actors/'
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
  loads "$1/skills/echo/bin/echo" 'libcaf|libfastrtps|libopencv|libyaml'
  # OpenCV's codecs would bring 118 MB into a container's image, its video
  # input 218 MB.
  loads "$1/skills/image_source/bin/image_source" 'libcaf|libopencv'
  loads "$1/skills/pose_estimation/bin/pose_estimation" 'libcaf|libopencv'
  loads "$1/skills/rectify/bin/rectify" 'libcaf|libopencv'
  loads "$1/skills/convert/bin/convert" 'libcaf|libopencv'
  loads "$1/skills/video_source/bin/video_source" 'libcaf'
fi

# A newcomer reads a folder's names at one glance.
crowded=$(git ls-files actors client dds embedding include messages schemas skills tools test \
  | grep -E '\.(hpp|cpp|sh)$' | xargs -n1 dirname | sort | uniq -c \
  | awk '$1 > 40 {print "law: " $2 " holds " $1 " files, more than 40"}')
if [[ -n $crowded ]]; then
  echo "$crowded"
  broken=1
fi

# Folders that stand beside each other know each other in one direction only.
python3 tools/check_circles.py || broken=1

# So do the parts of the coordinator.
if ! circle=$(grep -roE '#include "actors/cell/[^"]+' --include='*.?pp' actors/cell \
  | sed -E 's/^(.*)\.[ch]pp:#include "(.*)\.hpp$/\1 \2/' | awk '$1 != $2' \
  | tsort 2>&1 > /dev/null); then
  echo "law: these include each other in a circle:"
  echo "$circle"
  broken=1
fi

# So do the folders of what runs instances, but for the limits that they share.
if ! circle=$(grep -roE '#include "actors/instances/[^"]+' --include='*.?pp' actors/instances \
  | grep -v '/limits\.hpp$' | sed -E 's|^(.*)/[^/]+:#include "(.*)/[^/]+$|\1 \2|' | awk '$1 != $2' | sort -u \
  | tsort 2>&1 > /dev/null); then
  echo "law: these folders include each other in a circle:"
  echo "$circle"
  broken=1
fi

# Waiting is for events; a loop that sleeps wakes an idle robot.
if grep -rnE 'sleep_for|sleep_until|usleep\(' --include='*.?pp' \
     client dds embedding include messages schemas actors skills tools test; then
  echo "law: nothing sleeps"
  broken=1
fi

# A skill that is started must not hold what is this program's. Only the shim
# gives standard streams away on purpose.
if grep -rPzo '(?<![.>\w])(open|openat|socket)\((?![^;]*CLOEXEC)[^;]*\b(O_RDONLY|O_WRONLY|O_RDWR|SOCK_STREAM|SOCK_DGRAM|SOCK_RAW)\b[^;]*;' \
     --include='*.?pp' actors client dds embedding skills tools \
     | tr '\0' '\n' | grep -v '^$' | grep -v '^tools/instance_shim/main.cpp:open("/dev/null", O_RDWR)' \
   || grep -rnE '(^|[^A-Za-z_])::(dup|accept|pipe|inotify_init|epoll_create|mkstemp)\(|F_DUPFD\b' \
     --include='*.?pp' actors client dds embedding skills tools; then
  echo "law: a descriptor is opened with CLOEXEC"
  broken=1
fi

# What hangs in the kernel ends no wait, even after SIGKILL. The shell waits for
# the program that its user sees.
if grep -rnE 'waitpid\([^;]*, 0\)|waitid\([^;]*WEXITED\)' --include='*.?pp' \
     actors client dds embedding skills tools/roscell \
     | grep -v '^tools/roscell/shell/child.cpp:'; then
  echo "law: the end of a process is waited for by its pidfd, for so long"
  broken=1
fi

# What watches an actor stays in that one's memory until it is taken back.
if grep -rnE '(->|\.)monitor\(' --include='*.?pp' actors embedding skills tools \
     | grep -v '^actors/core/watching.hpp:'; then
  echo "law: actors are watched by actors/core/watching.hpp, which says until when"
  broken=1
fi

# A delayed message keeps its receiver, and cannot be taken back.
if grep -rnE 'delayed_(anon_)?send|schedule_message' --include='*.?pp' \
     actors embedding skills tools | grep -v '^actors/core/alarm.hpp:'; then
  echo "law: an actor has actors/core/alarm.hpp, which ends with it; what lives as" \
    "long as its node is told later by its send_lasting_actor_later"
  broken=1
fi

[[ $broken -eq 0 ]] && echo "law: kept"
exit $broken
