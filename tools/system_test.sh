#!/usr/bin/env bash
# Runs system tests: real processes, real DDS, each on a host of its own where
# the machine can make one. Usage: tools/system_test.sh BUILD_DIR [PATTERN]
#
#   PATTERN               a regular expression; "^test_NAME$" is one test
#   ROSCELL_VARIANTS=WORD only this variant of what is run with several engines
#   ROSCELL_TEST_JOBS=N   so many at a time                      [two a core]
#
# The exit code is 0 if none failed.
set -uo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  '' | -h | --help) sed -n '2,9s/^# \{0,1\}//p' "$0"; [[ -n ${1:-} ]]; exit ;;
esac
. tools/testing/results.sh
export ROSCELL_PATTERN=${2:-.}
# As tools/test.sh has them, which says why.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:new_delete_type_mismatch=0}
build=$(realpath "$1")
[[ -f $build/CTestTestfile.cmake ]] \
  || { echo "system_test.sh: nothing is built in $1" >&2; exit 2; }
[[ -n $(tools/testing/list_system.sh "$ROSCELL_PATTERN") ]] \
  || { echo "system_test.sh: no test matches '$ROSCELL_PATTERN'" >&2; exit 2; }
exec ctest --test-dir "$build" -L '^system$' -j "${ROSCELL_TEST_JOBS:-$(test_jobs)}" \
  --output-on-failure
