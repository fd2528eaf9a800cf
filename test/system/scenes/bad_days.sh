# What goes wrong for a host of a cell (days_scene.sh): its programs, its power, its
# cable, its address. To be sourced by what has such hosts. $possible is the moment
# from which pictures can come again.

# host_of NAME: its network namespace.
host_of() {
  echo "${hosts[number_of[$1] - 1]}"
}

cable_of() {
  host_link "${number_of[$1]}"
}

# kill_node NAME: the node alone; its skills go on.
kill_node() {
  stop_node "$1" KILL
}

# kill_programs NAME: the node with its shims and skills, or containers. The boot is
# the same, and so are the cable and a program that its person has started.
kill_programs() {
  if [[ $1 == right && -n ${right_runtime:-} ]]; then
    stop_node "$1" KILL
    engine ps -q | xargs -r docker -H "unix://$engine_socket" kill > /dev/null
    return
  fi
  ip netns pids "$(host_of "$1")" | grep -vx "$guest" | xargs -r kill -KILL
  await_end "$1"
}

# kill_host NAME [up|down]: all that runs there at once, as when its power is cut:
# nobody is told, and the next boot has another id. Its cable is then as is said.
kill_host() {
  ip link set "$(cable_of "$1")" down
  ip netns pids "$(host_of "$1")" | xargs -r kill -KILL
  await_end "$1"
  ip link set "$(cable_of "$1")" "${2:-up}"
  cat /proc/sys/kernel/random/uuid > "$scratch/$1.boot"
}

# shut_down NAME: as systemd does it: the node ends first, which leaves what it runs,
# then all else is told to, and what does not obey is killed. The next boot has another
# id.
shut_down() {
  local host number
  host=$(host_of "$1")
  stop_node "$1"
  ip netns pids "$host" | xargs -r kill -TERM
  for number in $(ip netns pids "$host"); do
    timeout 15 tail --pid="$number" -f /dev/null || kill -KILL "$number"
  done
  cat /proc/sys/kernel/random/uuid > "$scratch/$1.boot"
}

# await_end NAME: of its node, which was killed.
await_end() {
  timeout "$deadline_s" tail --pid="${pid[$1]}" -f /dev/null \
    || fail "node $1 did not end"
}

# readdress NAME ADDRESS [SECONDS]: the host has this one from now on, instead of its
# own, or after so long without any.
readdress() {
  local host
  host=$(host_of "$1")
  ip -n "$host" addr flush dev eth0
  sleep "${3:-0}"
  ip -n "$host" addr add "$2/24" dev eth0
  ip -n "$host" route replace default dev eth0
  possible=$EPOCHREALTIME
}

# unplug NAME SECONDS: its cable is out for so long.
unplug() {
  ip link set "$(cable_of "$1")" down
  sleep "$2"
  plug "$1"
}

plug() {
  ip link set "$(cable_of "$1")" up
  possible=$EPOCHREALTIME
}

# replug NAME SECONDS: its interface is gone for so long, and is another one then.
replug() {
  local n=${number_of[$1]} host
  host=$(host_of "$1")
  ip -n "$host" link del eth0
  sleep "$2"
  ip link add "$(cable_of "$1")" type veth peer name eth0 netns "$host"
  ip link set "$(cable_of "$1")" master "$bridge" up
  ip -n "$host" link set eth0 up
  readdress "$1" "10.231.7.$n"
}

# send_to_sleep NAME SECONDS: nothing of the host runs for so long, and nothing is
# heard of it; its clocks go on. By the freezer where there is one.
send_to_sleep() {
  local group
  ip link set "$(cable_of "$1")" down
  group=$(make_freezer)
  stop_all "$1" "$group"
  sleep "$2"
  if [[ -n $group ]]; then
    echo 0 > "$group/cgroup.freeze"
    leave_freezer "$group"
  else
    ip netns pids "$(host_of "$1")" | xargs -r kill -CONT
  fi
  plug "$1"
}

# stop_all NAME GROUP: twice, for what has been started meanwhile.
stop_all() {
  local number round
  if [[ -z $2 ]]; then
    for round in 1 2; do
      ip netns pids "$(host_of "$1")" | xargs -r kill -STOP
    done
    return
  fi
  for round in 1 2; do
    for number in $(ip netns pids "$(host_of "$1")"); do
      # One that ends meanwhile cannot be moved.
      echo "$number" > "$2/cgroup.procs" 2> /dev/null
    done
  done
  echo 1 > "$2/cgroup.freeze"
  until grep -q 'frozen 1' "$2/cgroup.events"; do await_change; done
}

# make_freezer: a group of version 2, where who is frozen can be killed all the same;
# nothing where there is none.
make_freezer() {
  local root group
  for root in /sys/fs/cgroup/unified /sys/fs/cgroup; do
    [[ -f $root/cgroup.procs ]] \
      && group=$(mktemp -d "$root/roscell-test.XXXXXX" 2> /dev/null) || continue
    [[ ! -w $group/cgroup.freeze ]] || { echo "$group"; return; }
    rmdir "$group"
  done
}

# leave_freezer GROUP: whoever is in it is from now on where this test is. What is
# forked meanwhile is in it, too.
leave_freezer() {
  local number own
  own=$(dirname "$1")$(sed -n 's/^0:://p' /proc/self/cgroup)
  until rmdir "$1" 2> /dev/null; do
    for number in $(< "$1/cgroup.procs"); do
      echo "$number" > "$own/cgroup.procs" 2> /dev/null || [[ ! -d /proc/$number ]] \
        || fail "process $number does not leave its group"
    done
  done
}
