#!/usr/bin/env bash
# Runs the system tests: real processes, real DDS, namespaces where the machine
# has them. Usage: tools/system_test.sh BUILD_DIR [PATTERN]
set -uo pipefail
cd "$(dirname "$0")/.."
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "${1:?usage: tools/system_test.sh BUILD_DIR [PATTERN]}")
pattern=${2:-.}
passed=0 failed=0 skipped=0

# suite_hook FILE NAME: runs a function of the file once for all of its tests,
# if it has one. $suite is a folder that they share.
suite_hook() {
  [[ -n $1 ]] && grep -q "^$2()" "$1" || return 0
  (
    scratch=$suite
    . test/system/lib.sh
    . "$1"
    "$2"
  ) > "$suite/$2.output" 2>&1
}

end_suite() {
  suite_hook "$file" after_all
  rm -rf "$suite"
  file=
}

run_one() {
  local file=$1 test=$2
  scratch=$(mktemp -d /tmp/roscell-test.XXXXXX)
  (
    . test/system/lib.sh
    use_skills
    trap clean_up EXIT
    . "$file"
    "$test"
  ) > "$scratch/output" 2>&1
  local code=$?
  local name=${test#test_}
  name=${name//_/ }
  case $code in
    0) echo "  ok       $name"; ((++passed)) ;;
    77) echo "  SKIPPED  $name: $(cat "$scratch/skipped")"; ((++skipped)) ;;
    *)
      echo "  FAILED   $name"
      tail -n 15 "$scratch/output"
      for log in "$scratch"/*.log; do
        [[ -f $log ]] && { echo "    -- $log"; tail -n 8 "$log"; }
      done
      ((++failed))
      ;;
  esac
  rm -rf "$scratch"
}

file=
trap '[[ -n $file ]] && end_suite' EXIT
for file in test/system/*_test.sh; do
  tests=$(grep -oE '^test_[a-z0-9_]+' "$file" | grep -E "$pattern")
  [[ -n $tests ]] || continue
  echo "$(basename "$file" _test.sh):"
  suite=$(mktemp -d /tmp/roscell-suite.XXXXXX)
  suite_hook "$file" before_all
  for test in $tests; do
    run_one "$file" "$test"
  done
  end_suite
done
echo "system tests: $passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
