#!/usr/bin/env bash
# Tries the dashboard in a headless browser: `scene` with a real cell, `faults` and
# `load` with one that is made up (fake_cell.py).
# Usage: test/dashboard/run.sh BUILD_DIR scene|faults|load [OPTION-OF-THE-TEST...]
# $ROSCELL_DASHBOARD is the command that serves the page of the scene: it is told
# the node in $ROSCELL_TO and prints a line with the page's address.
set -uo pipefail
cd "$(dirname "$0")/../.."
usage='usage: test/dashboard/run.sh BUILD_DIR scene|faults|load [OPTION...]'
export ROSCELL_BUILD
ROSCELL_BUILD=$(realpath "${1:?$usage}")
what=${2:?$usage}
shift 2
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0:new_delete_type_mismatch=0}
python=/usr/bin/python3 # Selenium is Debian's.

case $what in
  scene) ;;
  faults) exec "$python" test/dashboard/fault_test.py "$@" ;;
  load) exec "$python" test/dashboard/load_test.py "$@" ;;
  *) echo "$usage" >&2; exit 2 ;;
esac

command=${ROSCELL_DASHBOARD:-$ROSCELL_BUILD/bin/roscell dashboard --no-browser}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/roscell-dashboard.XXXXXX")
. test/system/lib.sh
. test/dashboard/scene.sh
trap 'clean_up; rm -rf "$scratch"' EXIT

start_scene
ROSCELL_TO=$(jq -r .socket "$scratch/scene.json")
export ROSCELL_TO
exec {page}< <(exec $command)
echo $! >> "$scratch/pids"
url=
while [[ -z $url ]] && read -r -t "$deadline_s" line <&"$page"; do
  url=$(grep -oE 'https?://[^ ]+' <<< "$line")
done
[[ -n $url ]] || fail "the dashboard did not tell its address"
"$python" test/dashboard/dashboard_test.py --url "$url" --scene "$scratch/scene.json" "$@"
