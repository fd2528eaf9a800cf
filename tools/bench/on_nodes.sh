# Begins a benchmark of real nodes: the programs of the build folder $1, a
# scratch folder, and the helpers of the system tests. All of it goes at its end.
[[ -x $1/bin/roscell ]] \
  || { echo "SKIPPED: there is no $1/bin/roscell" >&2; exit 77; }
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "$1")
scratch=$(mktemp -d /tmp/roscell-bench.XXXXXX)
. test/system/lib.sh
. tools/bench/metrics.sh
trap 'clean_up 2> /dev/null; rm -rf "$scratch"' EXIT

skip() {
  echo "SKIPPED: $*" >&2
  exit 77
}
