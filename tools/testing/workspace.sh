# The workspace that a run of the tests has for itself: a folder for what they write,
# which a killed run leaves and the next one takes away, and enough of the disk.
# To be sourced in the root of the tree.

# Short, because paths of sockets and of Podman may not be long.
workspace_prefix=/tmp/roscell
# What a run writes at most: two builds, base images, the tests' own folders.
disk_mib=${ROSCELL_TEST_DISK_MIB:-7168}

# make_workspace: what is not there in one line, and false.
make_workspace() {
  mkdir -p "$logs"
  exec {tree_lock}> build/test-logs/lock
  flock -n "$tree_lock" || {
    echo "test.sh: another run is at work in this tree; wait for its end" >&2
    return 1
  }
  remove_workspaces_of_the_dead
  has_disk "$PWD" $((disk_mib - $(du -sm build | cut -f 1))) || return
  has_disk /tmp 1024 || return
  export TMPDIR ROSCELL_RESULTS
  TMPDIR=$(mktemp -d "$workspace_prefix.XXXXXX") || return
  chmod 1777 "$TMPDIR" # As /tmp.
  exec {workspace_lock}> "$TMPDIR/.lock"
  flock "$workspace_lock"
  ROSCELL_RESULTS=$logs/results.tsv
  : > "$ROSCELL_RESULTS"
}

# has_disk FOLDER MIB
has_disk() {
  local free
  free=$(df -m --output=avail "$1" | tail -n 1)
  [[ $free -ge $2 ]] || {
    echo "test.sh: $1 has $((free)) MiB free, and the run writes up to $2 MiB more:" \
      "make room, or clone to a larger disk" >&2
    return 1
  }
}

# A run that lives holds the lock of its workspace, and whatever it has started does.
remove_workspaces_of_the_dead() {
  local workspace cgroup
  for workspace in "$workspace_prefix".*; do
    [[ -e $workspace/.lock ]] || continue
    flock -n "$workspace/.lock" rm -rf "$workspace"
  done
  # Only those without a process can be removed.
  for cgroup in /sys/fs/cgroup{,/unified}/roscell-test.*; do
    [[ ! -d $cgroup ]] || find "$cgroup" -depth -type d -exec rmdir {} + 2> /dev/null
  done
}

give_workspace_back() {
  [[ -z ${TMPDIR:-} || $TMPDIR != "$workspace_prefix".* ]] || rm -rf "$TMPDIR"
}
