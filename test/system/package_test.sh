# Debian packages of this build, on a Debian that has never seen ROSCell.

. test/system/scenes/debian_host.sh
. tools/packaging/clean_root.sh

packages=$suite/packages

# The packages, the same once more as a newer version, and a Debian that has all
# that they need.
fetch_all() {
  command -v dh mmdebstrap > /dev/null || return
  tools/package.sh --build "$ROSCELL_BUILD" --output "$packages" \
    roscell roscell-skills || return
  mkdir "$packages/newer"
  local package
  for package in "$packages"/roscell_*.deb "$packages"/roscell-skills_*.deb; do
    dpkg-deb -R "$package" "$suite/tree"
    sed -i 's/^Version: .*/&+newer/' "$suite/tree/DEBIAN/control"
    dpkg-deb -Znone -b "$suite/tree" "$packages/newer"
    rm -r "$suite/tree"
  done
  clean_root systemd systemd-sysv "$packages"/roscell_*.deb \
    "$packages"/roscell-skills_*.deb > "$suite/root"
}

start_debian_with_packages() {
  need_debian_host
  compgen -G "$packages/newer/*.deb" > /dev/null \
    || fail "there are no packages: $(cat "$suite/fetch_all.output")"
  [[ -s $suite/root ]] \
    || skip "no Debian can be made: $(tail -n 1 "$suite/fetch_all.output")"
  start_debian "$(cat "$suite/root")"
  mkdir "$debian_root/packages"
  cp -rt "$debian_root/packages" "$packages"/roscell_*.deb \
    "$packages"/roscell-skills_*.deb "$packages/newer"
}

# apt ACTION WHAT...: there is no network. Patterns are those of files there.
apt() {
  on_debian sh -c "apt-get -q -y --no-install-recommends $*" \
    > "$scratch/apt.out" 2>&1 || fail "apt $1: $(tail "$scratch/apt.out")"
}

# socket_of NAME: of the node of roscell@NAME, or of roscell.service for "".
socket_of() {
  echo "/var/lib/roscell${1:+-nodes/$1}/node.sock"
}

# node NAME COMMAND...: a client command, spoken to a node there.
node() {
  on_debian roscell "$2" --to "$(socket_of "$1")" "${@:3}"
}

# await_line WORDS COMMAND...: until it prints a line with these words.
await_line() {
  grep -qm 1 "$1" < <(exec timeout "$deadline_s" "${@:2}" 2> "$scratch/stream.log") \
    || fail "no '$1' from: ${*:2}"
}

# await_event NAME EVENT: of such a node, since its start.
await_event() {
  await_line "\"event\":\"$2\"" nsenter -t "$init" -a -r -w roscell events \
    --to "$(socket_of "$1")" --since 0 -o jsonl
}

# What there is of ours; Debian's lists and logs are not.
traces() {
  on_debian find / -xdev '(' -path /packages -o -path /tmp ')' -prune -o \
    -iname '*roscell*' -print
}

# echoes LINE: the skill writes it to its output.
echoes() {
  echo "$1" >> "$debian_root/var/tmp/hello.in"
  await_line "$1" tail -s 0.1 -n +1 -F "$debian_root/var/tmp/hello.out"
}

# service_of UNIT: the process of its node.
service_of() {
  on_debian systemctl show -P MainPID "$1"
}

# says UNIT WORDS: its journal has a line with these words.
says() {
  on_debian journalctl -q -o cat -u "$1" > "$scratch/journal"
  grep -qF "$2" "$scratch/journal" \
    || fail "$1 does not say '$2': $(tail "$scratch/journal")"
}

configure_wrongly() {
  echo 'interfaces = lo' > "$debian_root/etc/roscell/wrong.conf"
  on_debian systemctl start roscell@wrong 2> /dev/null && fail "it starts"
  on_debian systemctl stop roscell@wrong
  says roscell@wrong "/etc/roscell/wrong.conf:1: there is no option 'interfaces'"
}

# The node of roscell.service, and another one of this host as coordinator.
start_nodes() {
  echo 'interface = lo' >> "$debian_root/etc/roscell/node.conf"
  on_debian systemctl -q enable --now roscell || fail "it does not start"
  echo 'label = place=arm' >> "$debian_root/etc/roscell/node.conf"
  printf '%s\n' 'name = head' 'coordinator = true' 'interface = lo' 'port = 0' \
    'discovery-port = 0' > "$debian_root/etc/roscell/head.conf"
  on_debian systemctl -q enable --now roscell@head || fail "no coordinator"
  on_debian systemctl restart roscell || fail "it does not start again"
  await_event head node_joined
}

start_task() {
  touch "$debian_root/var/tmp/hello.in"
  cat > "$debian_root/packages/hello.json" << 'JSON'
{ "type": "task_request", "task": "hello", "pipeline": [
  { "id": "say", "operation": "echo", "model": "plain", "labels": { "place": "arm" },
    "input": "/var/tmp/hello.in", "output": "/var/tmp/hello.out" } ] }
JSON
  node "" run /packages/hello.json > "$scratch/run.out" 2>&1 \
    || fail "refused: $(cat "$scratch/run.out")"
  shim=$(readlink "$debian_root"/var/lib/roscell/instances/*/pid | cut -d' ' -f 1)
  echoes first
}

test_a_packaged_node_is_installed_upgraded_removed_and_purged() {
  trap 'end_debian; clean_up' EXIT
  start_debian_with_packages
  expect "before" "$(traces)" ""
  apt install '/packages/*.deb'
  expect "before it is configured" "$(service_of roscell)" 0
  configure_wrongly
  start_nodes
  start_task
  local before
  before=$(service_of roscell)
  apt install '/packages/newer/*.deb'
  has_line newer <<< "$(on_debian dpkg-query -W roscell)" || fail "not upgraded"
  [[ $(service_of roscell) != "$before" ]] || fail "it was not started again"
  await_event "" instance_adopted
  expect "its process" \
    "$(readlink "$debian_root"/var/lib/roscell/instances/*/pid | cut -d' ' -f 1)" "$shim"
  echoes second
  await_event head node_joined
  apt remove roscell
  says roscell@head "task_terminated 'hello'"
  on_debian test ! -e "/proc/$shim" || fail "the instance runs on"
  on_debian test -e /var/lib/roscell/state.db || fail "its state has gone"
  apt purge roscell roscell-skills
  expect "what is left" "$(traces)" ""
}
