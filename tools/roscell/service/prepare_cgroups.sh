#!/bin/sh
# prepare-cgroups USER: makes the tree of cgroups in which the nodes of this user
# hold their instances to their limits, and gives it to him. A unit runs it as
# root before each start. What cannot be made is told by the node itself.
set -eu
user=$1
root=/sys/fs/cgroup

# give FOLDER: to the user, with what he needs to make others in it.
give() {
  for file in "$1" "$1/cgroup.procs" "$1/cgroup.threads" \
    "$1/cgroup.subtree_control" "$1/tasks"; do
    [ ! -e "$file" ] || chown "$user" "$file"
  done
}

# Version 2. The node lies in the same slice: a process may be moved by whoever
# may write into the cgroup.procs of the lowest cgroup above both of its places.
if [ -e "$root/cgroup.controllers" ]; then
  slice=$root/roscell.slice
  mkdir -p "$slice/instances"
  for controller in cpu memory pids; do
    echo "+$controller" 2> /dev/null > "$slice/cgroup.subtree_control" || true
    echo "+$controller" 2> /dev/null > "$slice/instances/cgroup.subtree_control" || true
  done
  chown "$user" "$slice/cgroup.procs"
  give "$slice/instances"
  exit
fi

# Version 1, a tree for each controller. systemd tidies those that it knows.
for controller in cpu cpuacct memory pids freezer; do
  [ -e "$root/$controller/tasks" ] || continue
  mkdir -p "$root/$controller/roscell-instances"
  give "$root/$controller/roscell-instances"
done
