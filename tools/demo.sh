#!/usr/bin/env bash
# Installs, builds, and runs a task on a cell of four nodes on this machine:
# what a first look at ROSCell needs. Cleans up after itself.
set -euo pipefail
cd "$(dirname "$0")/.."

say() {
  printf '\n== %s\n' "$*"
}

say "installing what is missing"
tools/install.sh
command -v jq > /dev/null || { apt-get install -y -qq jq > /dev/null; }
say "building (once)"
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
[[ -f build/release/build.ninja ]] || cmake --preset release > /dev/null
ninja -C build/release roscell instance_shim echo_skill | tail -n 1

roscell=$PWD/build/release/bin/roscell
dir=$(mktemp -d /tmp/roscell-demo.XXXXXX)
nodes=()
finish() {
  kill "${nodes[@]}" 2> /dev/null || true
  wait 2> /dev/null || true
  rm -rf "$dir"
}
trap finish EXIT

# start NAME OPTION...: starts a node and waits until it says that it is ready.
start() {
  local name=$1
  shift
  mkfifo "$dir/$name.ready"
  "$roscell" node --name "$name" --interface lo --port 0 --discovery-port 0 \
    --data-dir "$dir/$name" --skills build/release/skills --ready-fd 5 "$@" \
    5> "$dir/$name.ready" 2> "$dir/$name.log" &
  nodes+=($!)
  read -r -t 20 _ < "$dir/$name.ready" || { cat "$dir/$name.log"; exit 1; }
}

say "a coordination node and three primary nodes, each a process of its own"
start head --coordinator --cell demo
export ROSCELL_TO=$dir/head/node.sock
server=$("$roscell" cells -o json | jq -r '.. | .discovery_server? // empty' \
  | head -n 1)
for name in arm belt camera; do
  start "$name" --join "$server"
done
"$roscell" events --since 0 -o json \
  | while read -r line; do
      [[ $line == *'"size":4'* ]] && break
    done
"$roscell" nodes

say "one task: two steps, the second reads what the first writes"
echo "hello from the reader" > "$dir/first.txt"
cat > "$dir/task.json" << JSON
{ "type": "task_request", "task": "greeting", "pipeline": [
  { "id": "first", "operation": "echo", "model": "plain",
    "parameters": { "prefix": "one: " },
    "input":  { "protocol": "file", "endpoint": "$dir/first.txt", "data_type": "text/plain" },
    "output": { "protocol": "file", "endpoint": "$dir/second.txt", "data_type": "text/plain" } },
  { "id": "second", "operation": "echo", "model": "plain",
    "parameters": { "prefix": "two: " },
    "input":  { "protocol": "file", "endpoint": "$dir/second.txt", "data_type": "text/plain" },
    "output": { "protocol": "file", "endpoint": "$dir/third.txt", "data_type": "text/plain" } } ] }
JSON
touch "$dir/second.txt" "$dir/third.txt"
"$roscell" request "$dir/task.json"
"$roscell" instances
say "what came out at the end"
timeout 20 tail -n +1 -F "$dir/third.txt" 2> /dev/null | head -n 1

say "one request removes it"
echo '{"type":"task_termination","task":"greeting"}' | "$roscell" request
"$roscell" tasks
say "done"
