#!/usr/bin/env bash
# Shows that the tests are strict: builds each deliberate fault of test/faults
# into the program and runs the test that is to find it.
# Usage: tools/testing/faults.sh [--tree FOLDER] [PATTERN]
#
#   PATTERN        only faults whose file name matches
#   --tree FOLDER  this checkout, with its build/asan, instead of a clone of what
#                  is committed (build/faults); its sources are changed and put
#                  back
#
# A patch begins with what is wrong, and a line `Found by: unit PROGRAM "CASE"` or
# `Found by: system TEST`. The exit code is 0 if all are found.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit
here=$PWD tree= pattern=.
while [[ $# -gt 0 ]]; do
  case $1 in
    --tree) tree=$(realpath "${2:?--tree needs a folder}"); shift ;;
    -h | --help) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit ;;
    -*) echo "faults.sh: unknown option $1 (--help tells more)" >&2; exit 2 ;;
    *) pattern=$1 ;;
  esac
  shift
done
export ASAN_OPTIONS=detect_leaks=1:new_delete_type_mismatch=0
logs=$here/build/fault-logs
mkdir -p "$logs"
programs=(roscell instance_shim skills/all stock_program parameter_client
  delay_line bent_host render_scenes compare_poses robot_controller)

# make_clone: of what is committed, where an earlier one is built upon.
make_clone() {
  tree=$here/build/faults
  [[ -d $tree/.git ]] || git clone -q "$here" "$tree" || exit
  git -C "$tree" fetch -q origin HEAD && git -C "$tree" reset -q --hard FETCH_HEAD
}

put_back() {
  [[ -z ${applied:-} ]] || git -C "$tree" apply -R "$applied"
  applied=
}

# build_for TEST...: what the test needs.
build_for() {
  local targets=("$2")
  [[ $1 == unit ]] || targets=("${programs[@]}")
  ninja -C "$tree/build/asan" -j "$(build_jobs)" "${targets[@]}"
}

# passes TEST...: as "Found by" has it. Catch takes a comma for an "or".
passes() {
  case $1 in
    unit)
      (cd "$tree" \
        && timeout 300 "build/asan/bin/$2" --warn NoTests "${3//,/\\,}")
      ;;
    system) (cd "$tree" && tools/system_test.sh build/asan "^$2\$") ;;
  esac
}

# verdict_on PATCH TEST...
verdict_on() {
  git -C "$tree" apply "$1" || { echo "does not apply"; return; }
  applied=$1
  if ! build_for "${@:2}" >&2; then
    echo "does not compile"
  elif passes "${@:2}" >&2; then
    echo "NOT FOUND"
  else
    echo found
  fi
}

trap put_back EXIT
trap 'exit 130' INT TERM
[[ -n $tree ]] || make_clone
cd "$tree" || exit
. tools/building.sh
[[ -f build/asan/build.ninja ]] || cmake --preset asan -DROSCELL_WERROR=ON > "$logs/cmake" || exit
found=0 all=0
for patch in "$here"/test/faults/*.patch; do
  name=$(basename "$patch" .patch)
  [[ $name =~ $pattern ]] || continue
  begin=$EPOCHSECONDS verdict=
  # Words, of which the last may be in quotes.
  eval "test=($(sed -n 's/^Found by: //p' "$patch"))"
  if ! { build_for "${test[@]}" && passes "${test[@]}"; } > "$logs/$name" 2>&1; then
    verdict="its test fails without it, too"
  else
    verdict=$(verdict_on "$patch" "${test[@]}" 2> "$logs/$name")
    applied=$patch
    [[ $verdict != "does not apply" ]] || applied=
    put_back
  fi
  ((++all))
  [[ $verdict != found ]] || ((++found))
  printf '%-10s %s, by %s (%d s)\n' "$verdict" "$name" "${test[*]}" \
    $((EPOCHSECONDS - begin))
done
echo "$found of $all faults are found"
[[ $all -gt 0 && $found -eq $all ]]
