#!/usr/bin/env bash
# The whole matrix of days that go wrong for a host or for the coordinator, of which
# the suite has a part: each day of test/system/days_test.sh with all of its times, and
# those of a host with containers for each engine. It ends with a table: for each
# stream the seconds to the first picture from what made it possible, the longest time
# without one, and how many pictures are missing; then the seconds to the first one
# after each step was started anew, of the slowest stream. Needs root and some 40
# minutes. Usage: tools/testing/days.sh BUILD_DIR [PATTERN]
#
#   PATTERN  a regular expression; only the tests that match
set -uo pipefail
cd "$(dirname "$0")/../.."
: "${1:?usage: tools/testing/days.sh BUILD_DIR [PATTERN]}"
pattern=${2:-.}
export ROSCELL_BUILD ROSCELL_DAYS=whole ROSCELL_DAYS_FILE
# As tools/test.sh has them, which says why.
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:new_delete_type_mismatch=0}
ROSCELL_BUILD=$(realpath "$1")
ROSCELL_DAYS_FILE=$(mktemp /tmp/roscell-days.XXXXXX)
trap 'rm -f "$ROSCELL_DAYS_FILE"' EXIT

# list: what there is to run, as tools/testing/list_system.sh has it.
list() {
  tools/testing/list_system.sh '^test_data_flow_after_' | grep -E "$pattern"
}

# show: the figures as a table, with the days in their order.
show() {
  jq -rs '
    def of($day; $when): map(select(.day == $day and .when == $when));
    def on($stream): map(select(.stream == $stream))[0];
    map(select(.when != "at first")) as $all
    | ($all | map(.stream) | unique) as $streams
    | ($all | reduce .[].day as $x ([]; if index([$x]) then . else . + [$x] end)) as $days
    | ["day", $streams[], "anew"], ["-", ($streams[] | "-"), "-"],
      ($days[] as $day | ($all | of($day; "after the day")) as $after
        | ($all | of($day; "over the day")) as $over
        | [$day, ($streams[] as $s | "\($after | on($s).s) / \($over | on($s).gap_s) / \($over | on($s).missing)"),
           ($all | of($day; "after each step was started anew") | map(.s) | max)])
    | map(tostring) | "| " + join(" | ") + " |"' "$ROSCELL_DAYS_FILE"
}

failed=0
while read -r _ _ _ file variant tests; do
  read -ra tests <<< "$tests"
  tools/testing/run_system.sh "$file" "$variant" "${tests[@]}" < /dev/null
  [[ $? -eq 0 || $? -eq 77 ]] || failed=1
done < <(list)
show
exit "$failed"
