#!/usr/bin/env bash
# Lists what there is to run of the system tests, a line each: COST LANE NAME
# FILE VARIANT TEST... A file whose tests share what they start (it has
# before_all) is one line for each of its variants, any other file one for each
# test. What costs more is begun first; a file's line "slow=(TEST...)" names those
# of its tests that take a minute or more, "alone=(TEST...)" those beside which
# nothing runs: what they measure is a page's work on a core. Those of one lane go
# one after the other: an engine keeps its images, 1 GB of disk, so that there are
# two lanes for them, and a Debian with the packages for it 1.6 GB, so that it takes
# both: "0,1".
# Days (scenes/days_scene.sh) judge how soon pictures come, which six cameras and
# readers work on: one lane, which is begun first; where they need an engine, too,
# nothing runs beside them: "alone". "-" is none.
# Usage: tools/testing/list_system.sh [PATTERN], a regular expression that tests
# match. $ROSCELL_VARIANTS="docker" leaves other variants out.
set -uo pipefail
cd "$(dirname "$0")/../../test/system" || exit
pattern=${1:-.}

# words_of NAME FILE: of its line "NAME=(WORD...)".
words_of() {
  sed -n "s/^$1=(\(.*\))\$/\1/p" "$2"
}

# variants_of FILE: "-" for one without.
variants_of() {
  local all variant
  all=$(words_of variants "$1")
  for variant in ${all:--}; do
    [[ $variant == - || " ${ROSCELL_VARIANTS:-$all} " == *" $variant "* ]] \
      && echo "$variant"
  done
}

# next_lane FILE: sets lane.
next_lane() {
  lane=-
  ! grep -q scenes/days_scene.sh "$1" || lane=days
  if grep -q scenes/engine.sh "$1"; then
    [[ $lane == days ]] && lane=alone || lane=$((++engines % 2))
  fi
  ! grep -q scenes/debian_host.sh "$1" || lane=0,1
}

engines=0
for file in *_test.sh */*_test.sh; do
  mapfile -t tests < <(grep -oE '^test_[a-z0-9_]+' "$file" | grep -E "$pattern")
  [[ ${#tests[@]} -gt 0 ]] || continue
  name=$(basename "$file" _test.sh)
  if grep -q '^before_all()' "$file"; then
    while read -r variant; do
      entry=$name
      [[ $variant == - ]] || entry+=.$variant
      next_lane "$file"
      echo "${#tests[@]} $lane $entry $file $variant ${tests[*]}"
    done < <(variants_of "$file")
    continue
  fi
  slow=" $(words_of slow "$file") "
  alone=" $(words_of alone "$file") "
  for test in "${tests[@]}"; do
    next_lane "$file"
    [[ $alone != *" $test "* ]] || lane=alone
    cost=1
    [[ $slow != *" $test "* && $lane != days ]] || cost=20
    echo "$cost $lane $name.${test#test_} $file - $test"
  done
done
