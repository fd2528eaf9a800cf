#!/usr/bin/env bash
# entry.sh PART COMMAND...: an entry of CTest, whose time is written down for that
# part of the run (results.sh). It ends with whoever has started it.
. "$(dirname "$0")/results.sh"
measured "$1" setpriv --pdeathsig KILL -- "${@:2}"
