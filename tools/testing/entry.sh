#!/usr/bin/env bash
# entry.sh PART COMMAND...: an entry of CTest, whose time is written down for that
# part of the run (results.sh). It ends with whoever has started it. It has a
# session of its own: a test may stop processes, and the kernel sends SIGHUP to all
# of a process group that has stopped ones when nobody is left to wake them.
. "$(dirname "$0")/results.sh"
measured "$1" setpriv --pdeathsig KILL -- setsid "${@:2}"
