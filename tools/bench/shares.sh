# Gives each node of a benchmark an equal share of the machine, as machines of
# their own would have. Sourced.

# make_share NAME CORES: a control group that may use so many cores (0.4).
# Prints its folder; nothing where this machine's cgroups cannot be written.
make_share() {
  local root=/sys/fs/cgroup folder period_us=100000
  local quota_us
  quota_us=$(awk -v cores="$2" -v period="$period_us" \
    'BEGIN {print int(cores * period)}')
  if [[ -w $root/cgroup.subtree_control ]]; then
    echo +cpu > "$root/cgroup.subtree_control" 2> /dev/null
    folder=$root/roscell-bench-$$-$1
    mkdir "$folder" && echo "$quota_us $period_us" > "$folder/cpu.max"
  elif [[ -w $root/cpu ]]; then
    folder=$root/cpu/roscell-bench-$$-$1
    mkdir "$folder" && echo "$period_us" > "$folder/cpu.cfs_period_us" \
      && echo "$quota_us" > "$folder/cpu.cfs_quota_us"
  else
    return 1
  fi 2> /dev/null && echo "$folder"
}

# The command prefix that begins a program in a share.
in_share() {
  inside=(sh -c 'echo $$ > "$0/cgroup.procs" && exec "$@"' "$1")
}

# The groups that are empty again.
remove_shares() {
  rmdir /sys/fs/cgroup/roscell-bench-$$-* /sys/fs/cgroup/cpu/roscell-bench-$$-* \
    2> /dev/null
}
