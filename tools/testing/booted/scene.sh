# What scripts on a booted Debian share (tools/testing/booted_debian.sh). To be
# sourced there, in the folder with the files that came along.

set -o pipefail

skills=/var/lib/roscell/skills
deadline_s=${deadline_s:-120}

fail() {
  echo "FAILED: $*"
  journalctl -q --no-pager -u roscell -n 30 | sed 's/^/  journal: /'
  exit 1
}

# A build with sanitizers does here, too: Fast DDS has what they dislike.
export ASAN_OPTIONS=detect_leaks=0:new_delete_type_mismatch=0
systemctl set-environment "ASAN_OPTIONS=$ASAN_OPTIONS"

# say WHAT: a part of the script begins.
say() {
  echo "== $*"
}

# expect WHAT IS WANTED
expect() {
  [[ $2 == "$3" ]] || fail "$1: '$2', wanted '$3'"
  echo "ok: $1: $2"
}

# holds WHAT COMMAND...: which succeeds.
holds() {
  "${@:2}" > /tmp/holds.out 2>&1 || fail "$1: $(tail -n 3 /tmp/holds.out)"
  echo "ok: $1"
}

# until_holds WHAT COMMAND...: which succeeds sooner or later.
until_holds() {
  local end=$((SECONDS + deadline_s))
  until "${@:2}" > /tmp/holds.out 2>&1; do
    [[ $SECONDS -lt $end ]] || fail "$1: $(tail -n 3 /tmp/holds.out)"
    sleep 1
  done
  echo "ok: $1"
}

# install_packages FILE...: there is no network.
install_packages() {
  DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install \
    "$@" > /tmp/apt.out 2>&1 || fail "apt: $(tail -n 5 /tmp/apt.out)"
}

# configure_node LINE...: a coordinator on loopback, of processes.
configure_node() {
  printf '%s\n' 'name = head' 'coordinator = true' 'interface = lo' \
    'runtime = process' "$@" > /etc/roscell/node.conf
}

# make_skill NAME DEPLOYMENT < SCRIPT: a skill that is a script of sh. It says
# that it is there, and lives on until it is ended; before, it runs the script.
# DEPLOYMENT: more members of its deployment, ", ..." or nothing.
make_skill() {
  local folder=$skills/$1
  mkdir -p "$folder/bin"
  cat > "$folder/skill.json" << JSON
{ "operation": "$1", "engine": "primitive", "entry_point": ["bin/run"],
  "input": { "data_types": ["text/plain"], "protocols": ["file"] },
  "output": { "data_types": ["text/plain"], "protocols": ["file"] },
  "models": [ { "name": "plain", "deployments": [ { "name": "cpu",
    "base_image": "debian:bookworm-slim", "architectures": ["amd64"],
    "resources": { "cpu": 0.1, "memory_mib": ${memory_mib:-64}, "disk_mib": 1 }
    $2 } ] } ] }
JSON
  {
    echo '#!/bin/sh'
    echo 'while :; do systemd-notify --ready WATCHDOG=1; sleep 2; done &'
    cat
    echo 'echo "the end of the script: $?"'
    echo 'wait'
  } > "$folder/bin/run"
  chmod -R a+rX "$folder"
  chmod a+x "$folder/bin/run"
}

# request TASK SKILL [MORE]: prints a request of one step.
request() {
  cat << JSON
{ "type": "task_request", "task": "$1", "pipeline": [ { "id": "s",
  "operation": "$2", "model": "plain" ${3:-} } ] }
JSON
}

# run_task TASK SKILL [MORE]
run_task() {
  request "$@" > "/tmp/$1.json"
  roscell run "/tmp/$1.json" > "/tmp/$1.out" 2>&1 \
    || fail "task $1: $(cat "/tmp/$1.out")"
  echo "ok: task $1 runs"
}

# log_of TASK
log_of() {
  roscell logs "$1" 2> /dev/null || roscell logs -t "$1"
}

says_in_log() {
  log_of "$1" | grep -qF "$2"
}

# pid_of TASK: of the process of its only instance, below the shim.
pid_of() {
  local folder
  for folder in /var/lib/roscell/instances/*; do
    if tr '\0' '\n' < "/proc/$(readlink "$folder/pid" | cut -d' ' -f3)/environ" \
      2> /dev/null | grep -qx "ROSCELL_TASK=$1"; then
      readlink "$folder/pid" | cut -d' ' -f3
    fi
  done
}
