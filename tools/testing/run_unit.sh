#!/usr/bin/env bash
# run_unit.sh PROGRAM INDEX COUNT: runs every COUNT-th test case of a Catch program,
# from the INDEX-th on, on a host of its own where this machine can make one. The
# program writes down each case (test/main.cpp); of one that ends the program the
# name is written down here.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit
. tools/testing/results.sh
program=$1 index=$2 count=$3
here=$(mktemp -d "${TMPDIR:-/tmp}/unit.XXXXXX")
trap 'rm -rf "$here"' EXIT
touch "$here/results"

"$program" --list-test-names-only \
  | awk -v i="$index" -v n="$count" 'NF && k++ % n == i' > "$here/names"
wanted=$(wc -l < "$here/names")
# Catch takes a line of a file for a name in quotes, in which a comma ends it, too.
sed 's/[\\",]/\\&/g' "$here/names" > "$here/quoted"
inside=()
! tools/testing/sandbox.sh --probe > /dev/null 2>&1 \
  || inside=(tools/testing/sandbox.sh)
ROSCELL_RESULTS=$here/results "${inside[@]}" "$program" \
  --input-file "$here/quoted" > "$here/said" 2>&1
code=$?
ran=$(wc -l < "$here/results")
[[ -z ${ROSCELL_RESULTS:-} ]] || cat "$here/results" >> "$ROSCELL_RESULTS"
[[ $code -ne 0 || $ran -ne $wanted ]] || exit 0
cat "$here/said"
if [[ $ran -lt $wanted ]]; then
  name=$(sed -n "$((ran + 1))p" "$here/names")
  write_case unit "$name" 0 FAILED \
    "the program ended with code $code; $((wanted - ran - 1)) more were not run"
  printf '    -- alone: %s %q\n' "$program" "$(sed 's/[\\",[]/\\&/g' <<< "$name")"
fi
exit 1
