#!/usr/bin/env bash
# Runs the system tests: real processes, real DDS, namespaces where the machine
# has them. Usage: tools/system_test.sh BUILD_DIR [PATTERN]
# A file of tests with a line "variants=(A B)" is run once for each, which
# $variant tells it; $ROSCELL_VARIANTS="B" leaves the others out.
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

# variants_of FILE: the words of its line; "-" for a file without one.
variants_of() {
  local all variant
  all=$(sed -n 's/^variants=(\(.*\))$/\1/p' "$1")
  for variant in ${all:--}; do
    [[ $variant == - || " ${ROSCELL_VARIANTS:-$all} " == *" $variant "* ]] \
      && echo "$variant"
  done
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
  [[ $variant == - ]] || name+=" ($variant)"
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

run_suite() {
  local test
  file=$1
  suite=$(mktemp -d /tmp/roscell-suite.XXXXXX)
  suite_hook "$file" before_all
  for test in $tests; do
    run_one "$file" "$test"
  done
  end_suite
}

file=
trap '[[ -n $file ]] && end_suite' EXIT
for tests_file in test/system/*_test.sh; do
  tests=$(grep -oE '^test_[a-z0-9_]+' "$tests_file" | grep -E "$pattern")
  [[ -n $tests ]] || continue
  echo "$(basename "$tests_file" _test.sh):"
  for variant in $(variants_of "$tests_file"); do
    run_suite "$tests_file"
  done
done
echo "system tests: $passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
