#!/usr/bin/env bash
# sandbox.sh COMMAND...: runs the command on a host of its own: its network has
# a loopback and nothing else; its processes, shared memory, message queues and
# named network namespaces are nobody else's. All of that is gone with the
# command, or with who has started it, however these end. The tree is also at
# $sandbox_tree, where every user may enter, whoever's folder it is in.
# It needs root; `sandbox.sh --probe` tells by its exit code whether this machine
# lets it.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit
export sandbox_tree=/run/roscell-tree

# What is mounted for it, in a mount namespace of its own. /sys shows the network
# of whoever mounts it; the cgroups are those of the host.
furnish() {
  mount -t proc proc /proc \
    && mount -t tmpfs -o mode=1777 tmpfs /dev/shm && mkdir /dev/shm/cgroup \
    && mount --rbind /sys/fs/cgroup /dev/shm/cgroup \
    && mount -t sysfs sysfs /sys \
    && mount --rbind /dev/shm/cgroup /sys/fs/cgroup \
    && umount -l /dev/shm/cgroup && rmdir /dev/shm/cgroup \
    && { [[ ! -d /dev/mqueue ]] || mount -t mqueue mqueue /dev/mqueue; } \
    && mkdir -p /run/netns && mount -t tmpfs -o mode=755 tmpfs /run/netns \
    && mkdir -p "$sandbox_tree" && mount --rbind . "$sandbox_tree" \
    && ip link set lo up
}

# The first process of the sandbox. It buries the orphans, and passes on what it
# is told to end by, so that the command may end in order.
inside() {
  local command code
  furnish || exit 125
  trap 'kill -TERM "$command" 2> /dev/null' INT TERM HUP
  "$@" &
  command=$!
  # A signal cuts a wait short.
  while wait "$command"; code=$?; kill -0 "$command" 2> /dev/null; do :; done
  exit "$code"
}

case ${1:-} in
  --inside) inside "${@:2}" ;;
  --probe) set -- true ;;
esac
[[ $(id -u) -eq 0 ]] || { echo "sandbox.sh: it needs root" >&2; exit 125; }
exec setpriv --pdeathsig KILL -- unshare --mount --net --pid --ipc --fork --kill-child \
  "$PWD/tools/testing/sandbox.sh" --inside "$@"
