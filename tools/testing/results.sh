# What a run of the tests writes down, to be sourced: a line for each case and a
# line for each command that ran some, in the file $ROSCELL_RESULTS, which
# tools/testing/summary.py reads. Fields are separated by tabs; a line is written
# whole, so that any number of processes may write.

# write_case PART NAME SECONDS OUTCOME [REASON]: OUTCOME is ok, SKIPPED or FAILED.
write_case() {
  [[ -z ${ROSCELL_RESULTS:-} ]] \
    || printf 'case\t%s\t%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$4" "${5:-}" \
      >> "$ROSCELL_RESULTS"
}

# measured PART COMMAND...: the command, whose time by the clock and on the cores
# is written down, with that of all its children that have ended.
measured() {
  local begin=$EPOCHREALTIME before code
  read_ticks
  before=$ticks
  "${@:2}"
  code=$?
  read_ticks
  [[ -z ${ROSCELL_RESULTS:-} ]] \
    || printf 'time\t%s\t%s\t%s\t%s\n' "$1" "$begin" "$EPOCHREALTIME" \
      $(((ticks - before) * 1000 / $(getconf CLK_TCK))) >> "$ROSCELL_RESULTS"
  return "$code"
}

# read_ticks: what this shell's children have had of the cores goes to $ticks, by
# the fields cutime and cstime of /proc/PID/stat.
read_ticks() {
  local stat
  stat=$(< "/proc/$BASHPID/stat")
  read -ra stat <<< "${stat##*) }"
  ticks=$((stat[13] + stat[14]))
}

# seconds_since BEGIN
seconds_since() {
  awk "BEGIN {printf \"%.2f\", $EPOCHREALTIME - $1}"
}

# test_jobs: how many tests run beside each other. Most of them wait, for leases
# and fences; each has nodes that take some 100 MiB with the sanitizers. Without a
# host of their own all use the same ports, names and shared memory.
test_jobs() {
  local memory_jobs
  tools/testing/sandbox.sh --probe > /dev/null 2>&1 || { echo 1; return; }
  memory_jobs=$(awk '/^MemAvailable/ {print int($2 / 1024 / 1024)}' /proc/meminfo)
  echo $(($(nproc) * 2 < memory_jobs ? $(nproc) * 2 : memory_jobs + 1))
}
