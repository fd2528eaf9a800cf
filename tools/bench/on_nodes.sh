# Begins a script of real nodes outside of the suite, such as a benchmark: the
# programs of the build folder $1, a scratch folder, the helpers of the system tests,
# and what is counted and printed with. All of it goes at the end of the shell that
# sources this.
[[ -x $1/bin/roscell ]] \
  || { echo "SKIPPED: there is no $1/bin/roscell" >&2; exit 77; }
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "$1")
scratch=$(mktemp -d /tmp/roscell-bench.XXXXXX)
. test/system/lib.sh
trap 'clean_up 2> /dev/null; rm -rf "$scratch"' EXIT

skip() {
  echo "SKIPPED: $*" >&2
  exit 77
}

# figure NAME VALUE UNIT: one JSON line.
figure() {
  jq -nc --arg figure "$1" --argjson value "$2" --arg unit "$3" \
    '{$figure, $value, $unit}'
}

now_ms() {
  date +%s%3N
}

# Median of the numbers that come in.
median() {
  sort -n | awk '{x[NR] = $1} END {print x[int((NR + 1) / 2)]}'
}

# cpu_ns NAME: time that all threads of the node have run. Where it was started by
# `ip netns exec`, that has replaced itself by the node.
cpu_ns() {
  cat /proc/"${pid[$1]}"/task/*/schedstat | awk '{sum += $1} END {printf "%.0f\n", sum}'
}

# memory_kib NAME KIND: such as Pss, of that node.
memory_kib() {
  awk -v key="$2:" '$1 == key {print $2}' "/proc/${pid[$1]}/smaps_rollup"
}
