# Limits of instances where cgroups of version 2 have controllers, across restarts
# of the unit. Files: scene.sh and the packages.
. ./scene.sh

install_packages ./*.deb
mkdir -p "$skills"
memory_mib=64 make_skill worker '' << 'SH'
cat /proc/self/cgroup
SH
# It takes more than it may have, when it is told.
memory_mib=64 make_skill glutton '' << 'SH'
while [ ! -e /tmp/eat ]; do sleep 1; done
exec awk 'BEGIN { x = "ten letter"; while (length(x) < 1e5) x = x x; while (1) a[n++] = x n }'
SH
chown -R roscell: /var/lib/roscell
configure_node
holds "the node starts" systemctl start roscell
tree=/sys/fs/cgroup/roscell.slice
grep . "$tree/cgroup.subtree_control" "$tree/instances/cgroup.subtree_control"
stat -c '%U %n' "$tree/cgroup.procs" "$tree/instances" "$tree/instances/cgroup.subtree_control"
journalctl -q --no-pager -o cat -u roscell | grep -i "limits of instances" || true
run_task work worker
process=$(pid_of work)

# place PID: the folder of its cgroup.
place() {
  echo "/sys/fs/cgroup$(sed -n 's/^0:://p' "/proc/$1/cgroup")"
}

# figures WHEN: limits and figures of the worker.
figures() {
  say "$1"
  until_holds "the node is there" sh -c 'roscell instances | grep -q running'
  expect "the process" "$(pid_of work)" "$process"
  echo "cgroup $(place "$process")"
  [[ $(place "$process") == "$tree/instances/"* ]] || fail "it lies outside of the tree"
  expect "memory.max" "$(cat "$(place "$process")/memory.max")" $((64 * 1024 * 1024))
  echo "cpu.weight $(cat "$(place "$process")/cpu.weight"), memory.current $(cat "$(place "$process")/memory.current")"
  roscell instances
  roscell describe instance "$(basename "$(grep -l . /var/lib/roscell/instances/*/log.0 | head -n 1 | xargs dirname)")" 2> /dev/null \
    | grep -iE 'memory|cpu|limit|use' || true
}

figures "at the start"
node=$(systemctl show -P MainPID roscell)
holds "systemctl restart" systemctl restart roscell
[[ $(systemctl show -P MainPID roscell) != "$node" ]] || fail "the same node"
figures "after systemctl restart"
node=$(systemctl show -P MainPID roscell)
kill -9 "$node"
until_holds "systemd starts it again" sh -c \
  "pid=\$(systemctl show -P MainPID roscell); [ \$pid != 0 ] && [ \$pid != $node ]"
figures "after kill -9 of the node"
holds "daemon-reload" systemctl daemon-reload
figures "after daemon-reload"

say "out of memory"
run_task greedy glutton ', "restart": { "policy": "never" }'
holds "one more restart, with both" systemctl restart roscell
until_holds "the node is there" roscell status
touch /tmp/eat
until_holds "it is told" sh -c 'roscell instances | grep -i "out of memory"'
roscell instances
timeout 10 roscell events --since 0 | grep -i "out of memory" | head -n 3 || true

say "the end"
holds "the task is stopped" roscell stop work
holds "the other one" roscell stop greedy
until_holds "its cgroup is gone" sh -c \
  "[ -z \"\$(find $tree/instances -mindepth 2 -type d)\" ]"
find "$tree" -type d
