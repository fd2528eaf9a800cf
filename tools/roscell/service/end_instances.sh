#!/bin/sh
# end-instances [DATA_DIR]: ends what the node of this data directory runs, before
# it is removed for good. A node that can be asked ends the tasks of its
# instances everywhere, as `roscell stop` does; so its cell is told. What is left
# of its processes gets SIGTERM, and after 10 s is killed.
#   DATA_DIR  [/var/lib/roscell]
set -eu
data_dir=${1:-/var/lib/roscell}
roscell=$(dirname "$0")/../../bin/roscell
export ROSCELL_TO="$data_dir/node.sock"

# The tasks of which something runs on this node.
tasks_here() {
  name=$("$roscell" status | awk '$1 == "name" {print $2}')
  "$roscell" instances --no-headers --columns node,state,task \
    | awk -v name="$name" \
      '$1 == name && $2 != "stopped" && $2 != "failed" {print $3}' | sort -u
}

# end_shim PID START_TIME: the number may be that of another process by now.
end_shim() {
  [ "$(cut -d' ' -f22 "/proc/$1/stat" 2> /dev/null)" = "$2" ] || return 0
  kill -TERM "$1" 2> /dev/null || return 0
  timeout 10 tail -s 0.1 --pid="$1" -f /dev/null || kill -QUIT "$1" || true
}

if [ -S "$ROSCELL_TO" ] && tasks=$(tasks_here 2> /dev/null); then
  for task in $tasks; do
    "$roscell" stop --timeout 20 "$task" > /dev/null \
      || echo "roscell: task '$task' cannot be ended, see above" >&2
  done
fi
for record in "$data_dir"/instances/*/pid; do
  # A link whose target says it; earlier versions have written a file.
  words=$(readlink "$record" || cat "$record" 2> /dev/null) || continue
  end_shim "$(echo "$words" | cut -d' ' -f1)" "$(echo "$words" | cut -d' ' -f2)"
done
