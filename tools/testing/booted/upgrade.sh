# From a package whose node is root to one with a user of its own, with a step that
# may move. Files: scene.sh, the packages, and in old/ those of before.
. ./scene.sh

say "the package of before"
install_packages ./old/*.deb
expect "its version" "$(dpkg-query -W -f '${Version}' roscell)" 0.1.0
mkdir -p "$skills"
make_skill worker '' << 'SH'
echo "I am $(id -un)"
SH
printf '%s\n' 'name = head' 'coordinator = true' 'interface = lo' 'port = 0' \
  'discovery-port = 0' 'runtime = process' > /etc/roscell/head.conf
printf '%s\n' 'name = arm' 'interface = lo' 'label = place=arm' \
  'runtime = process' > /etc/roscell/node.conf
holds "a coordinator starts" systemctl start roscell@head
holds "the node starts" systemctl start roscell
until_holds "it joins" sh -c 'roscell status | grep -q "state.*member"'
expect "its user" "$(ps -o user= -p "$(systemctl show -P MainPID roscell)")" root
moving=', "labels": { "place": "arm" }, "on_node_loss": { "policy": "move", "after_s": 60 }'
until_holds "the task runs" run_task work worker "$moving"
before=$(pid_of work)
[[ -n $before ]] || fail "no process"
echo "ok: a running step with the policy move, process $before, fence in $(ls -d /dev/shm/roscell-0)"

say "the new package"
install_packages ./*.deb
grep -i 'roscell: ' /tmp/apt.out || true
until_holds "the node is back" roscell status
expect "its user" "$(ps -o user= -p "$(systemctl show -P MainPID roscell)")" root
expect "the process of the step" "$(pid_of work)" "$before"
until_holds "it says that it is root" sh -c \
  'journalctl -q -o cat -u roscell | grep -F "runs as root"'
journalctl -q -o cat -u roscell | grep -F "runs as root" | tail -n 1
roscell doctor --only node-user 2>&1 | head -n 5 || true

say "moving with an instance of root's left"
! /usr/lib/roscell/move-to-user > /tmp/move.out 2>&1 || fail "it moves"
cat /tmp/move.out
grep -q "work-s-" /tmp/move.out || fail "it does not name what is left"
expect "the node" "$(systemctl is-active roscell)" active
until_holds "the step goes on" test -e "/proc/$before"

say "moving when none is left"
until_holds "it is in its cell" sh -c 'roscell status | grep -q "state.*member"'
holds "the task is stopped" roscell stop work
holds "it moves" /usr/lib/roscell/move-to-user
cat /tmp/holds.out
until_holds "the node is back" roscell status
expect "its user" "$(ps -o user= -p "$(systemctl show -P MainPID roscell)")" roscell
expect "whose data it is" "$(find /var/lib/roscell ! -user roscell | wc -l)" 0
until_holds "it is in its cell" sh -c 'roscell status | grep -q "state.*member"'
until_holds "a task runs" run_task again worker "$moving"
until_holds "who the step is" says_in_log again "I am roscell"
ls -d /dev/shm/roscell-"$(id -u roscell)" || fail "no fence"
echo "kept logs and history of before:"
roscell logs --previous | head -n 5
! /usr/lib/roscell/move-to-user > /tmp/move.out 2>&1 || fail "it moves twice"
cat /tmp/move.out
holds "it ends" roscell stop again
