#!/usr/bin/env bash
# Installs, builds and tests; prints a summary. Fast the second time.
# Options: --lint, --unit, --system, --fuzz or --tidy run that part only.
set -uo pipefail
cd "$(dirname "$0")/.."

fuzz_seconds=${ROSCELL_FUZZ_SECONDS:-5}
parts=${1:-all}
log=build/test-logs
passed=0 failed=0 skipped=0
skip_reasons=()
. tools/building.sh
may_build || exit 1
mkdir -p "$log"
SECONDS=0

wants() {
  [[ $parts == all || $parts == "--$1" ]]
}

say() {
  printf '[%4d s] %s\n' "$SECONDS" "$*"
}

# report NAME STATUS: counts a check, and shows the end of its log if it failed.
report() {
  if [[ $2 -eq 0 ]]; then
    say "ok      $1"
    ((++passed))
  else
    say "FAILED  $1 ($log/$1.log)"
    tail -n 40 "$log/$1.log"
    ((++failed))
  fi
}

# check NAME COMMAND...: one check that passes or fails as a whole.
check() {
  "${@:2}" > "$log/$1.log" 2>&1
  report "$1" $?
}

# begin NAME COMMAND...: a check that only computes, at low priority beside the
# tests, which mostly wait; `finish NAME` waits for it.
declare -A begun
begin() {
  rm -f "$log/$1.status"
  set -m # A process group of its own, which can be ended as a whole.
  {
    renice -n 19 -p "$BASHPID"
    "${@:2}"
    echo $? > "$log/$1.status"
  } > "$log/$1.log" 2>&1 &
  begun[$1]=$!
  set +m
}

# The status is in a file, for the shell forgets one whose process id it has seen
# again, as it does after 32768 processes.
finish() {
  wait "${begun[$1]}" 2> /dev/null
  report "$1" "$(cat "$log/$1.status" 2> /dev/null || echo 1)"
  unset "begun[$1]"
}

end_begun() {
  local job
  for job in "${begun[@]}"; do
    kill -- "-$job" 2> /dev/null
  done
}
trap end_begun EXIT

configure() {
  [[ -f build/$1/build.ninja ]] || cmake --preset "$1" "${@:2}"
}

build_asan() {
  configure asan -DROSCELL_WERROR=ON && ninja -C build/asan -j "$(build_jobs)"
}

format() {
  git ls-files '*.hpp' '*.cpp' | xargs clang-format --dry-run --Werror
}

tidy() {
  python3 tools/tidy.py build/asan
}

build_fuzz() {
  cmake --preset fuzz -DROSCELL_FUZZ_SECONDS="$fuzz_seconds" && ninja -C build/fuzz -j "$(build_jobs)" fuzzers
}

# Counts the test cases of one Catch program; one that does not tell how many it
# has run has not passed.
unit() {
  local program=$1 name cases
  name=$(basename "$program")
  if timeout 300 "$program" -r compact > "$log/$name.log" 2>&1 \
    && cases=$(grep -oE '[0-9]+ test case' "$log/$name.log") \
    && [[ ${cases%% *} -gt 0 ]]; then
    say "ok      $name: ${cases}s"
    passed=$((passed + ${cases%% *}))
  else
    say "FAILED  $name ($log/$name.log)"
    tail -n 40 "$log/$name.log"
    ((++failed))
  fi
}

# Runs one fuzzer from its seeds for a bounded time.
fuzz() {
  local name inputs
  name=$(basename "$1")
  check "$name" ctest --test-dir build/fuzz -R "^$name\$" --verbose
  inputs=$(grep -oE 'executed_units: *[0-9]+' "$log/$name.log" | grep -oE '[0-9]+')
  echo "         $inputs inputs in $fuzz_seconds s"
}

system() {
  tools/system_test.sh build/asan | tee "$log/system.log"
  passed=$((passed + $(grep -c '^  ok ' "$log/system.log")))
  failed=$((failed + $(grep -c '^  FAILED ' "$log/system.log")))
  skipped=$((skipped + $(grep -c '^  SKIPPED ' "$log/system.log")))
  while read -r reason; do
    skip_reasons+=("$reason")
  done < <(grep '^  SKIPPED ' "$log/system.log")
}

say "installing"
tools/install.sh --with-tests || exit 1
# Fast DDS 2.9.1 deletes its statistics objects through a base class of another
# size; everything else that ASan checks stays on.
export ASAN_OPTIONS=detect_leaks=1:new_delete_type_mismatch=0
export UBSAN_OPTIONS=print_stacktrace=1

if wants lint; then
  check format format
  check law tools/check_law.sh
  check rules tools/check_rules.py
fi
say "building with ASan and UBSan, warnings as errors"
check build build_asan
if [[ $failed -gt 0 ]]; then
  echo "$passed passed, $failed failed"
  exit 1
fi
if wants lint; then
  check law-of-programs tools/check_law.sh build/asan
fi
wants fuzz && begin build-fuzz build_fuzz
wants tidy && begin tidy tidy
if wants unit; then
  for program in build/asan/bin/test_*; do
    unit "$program"
  done
fi
wants system && system
if wants fuzz; then
  finish build-fuzz
  for program in build/fuzz/bin/*_fuzz; do
    [[ -x $program ]] && fuzz "$program"
  done
fi
wants tidy && finish tidy

for reason in "${skip_reasons[@]}"; do
  echo "$reason"
done
say "done"
echo "$passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
