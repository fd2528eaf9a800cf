#!/usr/bin/env bash
# Installs, builds and tests; ends with a table of where the time went, the
# slowest tests, and how many have passed.
# Usage: tools/test.sh [--lint|--unit|--system|--fuzz|--tidy]
#
#   --lint, --unit, --system, --fuzz
#             that part only
#   --tidy    clang-tidy on all sources; without it on those that the change
#             touches, and in CI on the others, too, while there is time
#
#   ROSCELL_TEST_JOBS=N     tests beside each other             [two a core]
#   ROSCELL_FUZZ_SECONDS=N  how long each fuzzer runs                   [15]
#   ROSCELL_TIDY_MINUTES=N  minutes after which CI looks at no more sources
#                           that the change does not touch              [40]
set -uo pipefail
cd "$(dirname "$0")/.."

part=${1:-all}
case $part in
  all | --lint | --unit | --system | --fuzz | --tidy) ;;
  -h | --help) sed -n '2,16s/^# \{0,1\}//p' "$0"; exit ;;
  *) echo "test.sh: unknown option $part (--help tells more)" >&2; exit 2 ;;
esac
fuzz_seconds=${ROSCELL_FUZZ_SECONDS:-15}
logs=$PWD/build/test-logs
begin=$EPOCHSECONDS
# What runs of this user know of each other, whatever clone they are of.
cache=${XDG_CACHE_HOME:-${HOME:-$PWD/build}/.cache}/roscell
. tools/building.sh
. tools/testing/results.sh
. tools/testing/workspace.sh
may_build || exit 1
make_workspace || exit 1

wants() {
  [[ $part == all || $part == "--$1" ]]
}

say() {
  printf '[%4d s] %s\n' $((EPOCHSECONDS - begin)) "$*"
}

# check PART NAME COMMAND...: one check that passes or fails as a whole. What it
# says is shown if it fails.
check() {
  local log=$logs/$2.log from=$EPOCHREALTIME outcome=ok
  measured "$1" "${@:3}" > "$log" 2>&1 || outcome=FAILED
  write_case "$1" "$2" "$(seconds_since "$from")" "$outcome"
  say "$(printf '%-7s %s' "$outcome" "$2")"
  [[ $outcome == ok ]] || { tail -n 40 "$log"; echo "    -- all of it: $log"; return 1; }
}

# begin COMMAND...: in the idle time of the others; `finish` waits for it and
# shows what it said.
begun=
begin() {
  set -m # A process group of its own, which can be ended as a whole.
  {
    renice -n 19 -p "$BASHPID"
    "$@" > "$logs/beside.said" 2>&1
  } > /dev/null &
  begun=$!
  set +m
}

finish() {
  wait "$begun" 2> /dev/null
  begun=
  cat "$logs/beside.said"
}

end_all() {
  trap '' INT TERM HUP
  [[ -z $begun ]] || kill -- "-$begun" 2> /dev/null
  give_workspace_back
}
trap end_all EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

build_asan() {
  [[ -f build/asan/build.ninja ]] \
    || cmake --preset asan -DROSCELL_WERROR=ON || return
  ninja -C build/asan -j "$(build_jobs)"
}

check_format() {
  git ls-files -z '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run --Werror
}

# run_tests LABELS: those of the build, side by side. What takes longest begins
# first, also in a clone that has not run any of them yet.
run_tests() {
  local costs=build/asan/Testing/Temporary/CTestCostData.txt
  mkdir -p "$(dirname "$costs")" "$cache"
  [[ -s $costs ]] || cp "$cache/test-costs" "$costs" 2> /dev/null
  # Of one that runs out of its time nobody writes a case down.
  ctest_of_build "$1" || grep -q $'\tFAILED\t' "$ROSCELL_RESULTS" \
    || write_case ctest "an entry of CTest, see above" 0 FAILED
  cp "$costs" "$cache/test-costs" 2> /dev/null
}

ctest_of_build() {
  setpriv --pdeathsig TERM -- ctest --test-dir build/asan -L "^($1)\$" \
    -j "${ROSCELL_TEST_JOBS:-$(test_jobs)}" --output-on-failure --no-tests=error \
    | grep --line-buffered -vE '^ *Start +[0-9]+:'
}

# With one compiler where tests have the memory.
build_fuzzers() {
  local jobs=1
  [[ $part == all ]] || jobs=$(build_jobs)
  cmake --preset fuzz && ninja -C build/fuzz -j "$jobs" fuzzers
}

# Each fuzzer goes on from what earlier runs have found, in any clone.
fuzz() {
  local program name
  check fuzz-build build-fuzzers build_fuzzers || return
  for program in build/fuzz/bin/*_fuzz; do
    name=$(basename "$program")
    check fuzz "$name" env ROSCELL_CORPUS="$cache/fuzz" \
      ROSCELL_FUZZ_SECONDS="$fuzz_seconds" \
      ctest --test-dir build/fuzz -R "^$name\$" --verbose --no-tests=error
    echo "         $(grep -oE 'executed_units: *[0-9]+' "$logs/$name.log" \
      | grep -oE '[0-9]+') inputs in $fuzz_seconds s"
  done
}

tidy() {
  local how=(--touched)
  [[ -z ${CI:-} ]] \
    || how=(--begin-until $((begin + 60 * ${ROSCELL_TIDY_MINUTES:-40})))
  [[ $part != --tidy ]] || how=()
  check tidy clang-tidy python3 tools/tidy.py build/asan "${how[@]}"
  echo "         $(tail -n 1 "$logs/clang-tidy.log")"
}

# One after the other: two compilers of each would take 2 GB more.
fuzz_and_tidy() {
  ! wants fuzz || fuzz
  ! wants tidy || tidy
}

say "installing"
measured install tools/install.sh --with-tests || exit 1
# Fast DDS 2.9.1 deletes its statistics objects through a base class of another
# size; everything else that ASan checks stays on.
export ASAN_OPTIONS=detect_leaks=1:new_delete_type_mismatch=0
export UBSAN_OPTIONS=print_stacktrace=1

if wants lint; then
  check lint format check_format
  check lint law tools/check_law.sh
  check lint rules tools/check_rules.py
  check lint words tools/check_words.py
  check lint docs tools/check_docs.py
  check lint reference tools/generate_reference.py --check
fi
if [[ $part != --fuzz ]]; then
  say "building with ASan and UBSan, warnings as errors"
  if ! check build build build_asan; then
    python3 tools/testing/summary.py "$ROSCELL_RESULTS" "$begin"
    exit 1
  fi
fi
! wants lint || check lint law-of-programs tools/check_law.sh build/asan
begin fuzz_and_tidy
tests=
! wants unit || tests=unit
! wants system || tests+=${tests:+|}system
[[ -z $tests ]] || run_tests "$tests"
finish
say "done"
python3 tools/testing/summary.py "$ROSCELL_RESULTS" "$begin"
