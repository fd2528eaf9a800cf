#!/usr/bin/env bash
# run_system.sh FILE VARIANT TEST...: runs these system tests of a file one after the
# other, on a host of their own where this machine can make one
# (tools/testing/sandbox.sh). As tools/testing/list_system.sh lists them; people use
# tools/system_test.sh. Exit code: 0 if all passed, 77 if all were skipped.
# $ROSCELL_BUILD is the build folder; what failed is kept in its test-logs.
set -uo pipefail
cd "$(dirname "$0")/../.."
. tools/testing/results.sh
: "${ROSCELL_BUILD:?the build folder}"
kept=$ROSCELL_BUILD/test-logs
mkdir -p "$kept"
export ROSCELL_BUILD kept

# hook NAME: runs a function of the file once for all of its tests, if it has one.
# What it says is in the folder that they share.
hook() {
  (
    scratch=$suite
    . test/system/lib.sh
    . "$file"
    ! declare -F "$1" > /dev/null || "$1"
  ) > "$suite/$1.output" 2>&1
}

# name_of TEST: as people read it.
name_of() {
  local name=${1#test_}
  name=${name//_/ }
  [[ $variant == - ]] || name+=" ($variant)"
  echo "$name"
}

# keep_logs TEST: the folder that has all that this test has written in words.
keep_logs() {
  local folder=$kept/$(basename "$file" _test.sh).${1#test_}
  [[ $variant == - ]] || folder+=.$variant
  rm -rf "$folder"
  mkdir -p "$folder"
  find "$scratch" -maxdepth 1 -type f -size -4M -exec cp -t "$folder" {} +
  echo "$folder"
}

# show_failure TEST CODE: what it said, what its nodes said, and how to run it
# alone.
show_failure() {
  local log folder
  folder=$(keep_logs "$1")
  tail -n 40 "$scratch/output"
  for log in "$scratch"/*.log; do
    [[ -s $log ]] && { echo "    -- $(basename "$log")"; tail -n 20 "$log"; }
  done
  echo "    -- all of it: $folder"
  echo "    -- alone: ${variant_setting}tools/system_test.sh $build_name '^$1\$'"
}

# run_one TEST
run_one() {
  local test=$1 code begin=$EPOCHREALTIME outcome reason=
  scratch=$(mktemp -d "${TMPDIR:-/tmp}/test.XXXXXX")
  (
    . test/system/lib.sh
    use_skills
    trap clean_up EXIT
    . "$file"
    "$test"
  ) > "$scratch/output" 2>&1
  code=$?
  case $code in
    0) outcome=ok ;;
    77) outcome=SKIPPED reason=$(cat "$scratch/skipped") ;;
    *) outcome=FAILED ;;
  esac
  printf '  %-8s %s%s\n' "$outcome" "$(name_of "$test")" "${reason:+: $reason}"
  [[ $outcome != FAILED ]] || show_failure "$test" "$code"
  write_case system "$(name_of "$test")" "$(seconds_since "$begin")" "$outcome" \
    "$reason"
  rm -rf "$scratch"
  outcomes+=" $outcome"
}

end_suite() {
  hook after_all
  rm -rf "$suite"
}

run_all() {
  local test outcomes=
  trap end_suite EXIT
  trap 'exit 130' INT TERM HUP
  hook before_all
  for test in "$@"; do
    run_one "$test"
  done
  [[ $outcomes != *FAILED* ]] || return 1
  [[ $outcomes == *ok* ]] || return 77
}

# There is no network inside.
if [[ ${1:-} != --inside ]]; then
  file=test/system/$1 variant=$2
  suite=$(mktemp -d "${TMPDIR:-/tmp}/suite.XXXXXX")
  export suite build_name=${ROSCELL_BUILD#"$PWD"/}
  hook fetch_all
  ! tools/testing/sandbox.sh --probe > /dev/null 2>&1 \
    || exec tools/testing/sandbox.sh tools/testing/run_system.sh --inside "$@"
  exec tools/testing/run_system.sh --inside "$@"
fi

shift
# Where every user may enter, whoever's folder the tree is in.
if [[ -n ${sandbox_tree:-} ]]; then
  [[ $ROSCELL_BUILD != "$PWD"/* ]] \
    || ROSCELL_BUILD=$sandbox_tree/${ROSCELL_BUILD#"$PWD"/}
  cd "$sandbox_tree" || exit
fi
file=test/system/$1 variant=$2
variant_setting=
[[ $variant == - ]] || variant_setting="ROSCELL_VARIANTS=$variant "
shift 2
run_all "$@"
