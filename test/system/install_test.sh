# What tools/install.sh, tools/demo.sh and `roscell doctor` say on a computer that
# is not ready; and the units as files: what systemd says of them, and what the
# manual does.

# fake COMMAND SCRIPT: that command of the test's PATH.
fake() {
  printf '#!/bin/sh\n%s\n' "$2" > "$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}

# bare_path: a PATH with little more than the scripts need, and no sudo.
bare_path() {
  local command
  mkdir "$scratch/bin"
  chmod a+rx "$scratch" "$scratch/bin"
  for command in bash env basename dirname realpath id grep tail mktemp mkdir \
    rm cat wc setpriv; do
    ln -s "$(command -v "$command")" "$scratch/bin/"
  done
  fake apt-get 'exit 0'
  fake dpkg-query 'exit 1'
}

# says_one_line WORDS COMMAND...: it fails, and tells why in one line with these
# words.
says_one_line() {
  local words=$1
  shift
  PATH=$scratch/bin "$@" < /dev/null > "$scratch/out" 2> "$scratch/err" \
    && fail "it did not fail"
  expect "lines of error" "$(wc -l < "$scratch/err")" 1
  grep -qF "$words" "$scratch/err" || fail "it says: $(cat "$scratch/err")"
}

as_nobody=()
if [[ $(id -u) -eq 0 ]]; then
  as_nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)
fi

test_who_is_not_root_and_has_no_sudo_is_told_what_root_must_run() {
  bare_path
  says_one_line "let root run: $PWD/tools/install.sh --with-tests" \
    "${as_nobody[@]}" tools/install.sh --with-tests
}

test_without_a_terminal_sudo_is_not_waited_for() {
  bare_path
  fake sudo '[ "$1" = -n ] && echo "sudo: a password is required" >&2; exit 1'
  fake setsid "exec $(command -v setsid) -w \"\$@\""
  says_one_line "cannot install: sudo: a password is required; fix that" \
    setsid "${as_nobody[@]}" tools/install.sh
}

test_the_reason_why_apt_fails_is_told_in_one_line() {
  [[ $(id -u) -eq 0 ]] || skip "installing needs root"
  bare_path
  fake apt-get 'echo "E: no network" >&2; echo "E: and more" >&2; exit 100'
  says_one_line "cannot install: E: no network" tools/install.sh
}

test_who_may_not_write_the_tree_is_told_so_before_anything_is_done() {
  bare_path
  mkdir -p "$scratch/tree/tools" "$scratch/tree/build"
  cp tools/*.sh "$scratch/tree/tools"
  chmod 0555 "$scratch/tree/build"
  says_one_line "build cannot be written by" \
    "${as_nobody[@]}" "$scratch/tree/tools/demo.sh"
}

# doctor OPTION...: its findings are in $scratch/found; gives its exit code. It
# looks for no other node of this machine. $inside may hold a command prefix.
data=data
doctor() {
  ROSCELL_TO=unix:$scratch/none.sock "${inside[@]}" "$ROSCELL" doctor -o json \
    --data-dir "$scratch/$data" "$@" > "$scratch/found" 2> "$scratch/doctor.err"
}

# found CHECK VERDICT WORDS: the last findings, which are there, have one of that
# check.
found() {
  jq -es --arg check "$1" --arg verdict "$2" --arg words "$3" \
    'any(.[][]; .check == $check and .verdict == $verdict
              and (.seen | contains($words)))' "$scratch/found" > /dev/null \
    || fail "$1 is not $2 with '$3': $(cat "$scratch/found" "$scratch/doctor.err")"
}

# remedies: the commands that the last findings name.
remedies() {
  jq -r '.[] | select(.verdict == "broken" or .verdict == "warning") | .remedy' \
    "$scratch/found"
}

# paste COMMANDS: as root does, who needs no sudo.
paste() {
  "${inside[@]}" bash -ec "sudo() { \"\$@\"; }; $1"
}

# is_mended CHECK [OPTION...]: what was found is gone after its own remedies.
is_mended() {
  local check=$1 commands
  shift
  commands=$(remedies)
  paste "$commands" || fail "not a command: $commands"
  doctor --only "$check" "$@"
  jq -e 'all(.[]; .verdict == "ok")' "$scratch/found" > /dev/null \
    || fail "after '$commands': $(cat "$scratch/found")"
}

test_a_check_of_doctor_is_found_by_its_former_name() {
  doctor --only shm-sharing
  expect "the checks" "$(jq -c '[.[].check] | unique' "$scratch/found")" '["leftovers"]'
}

# on_a_host: what follows is on a host of its own with eth0.
on_a_host() {
  bridge_hosts 1
  inside=(ip netns exec "${hosts[0]}")
}

test_doctor_tells_of_an_interface_without_address_down_or_not_there() {
  on_a_host
  doctor --only interface --interface eth0 || fail "$(cat "$scratch/found")"
  found interface ok "eth0 has 10.231.7.1"
  doctor --only interface --interface eth9 && fail "it is content"
  found interface broken "'eth9' is no interface"
  "${inside[@]}" ip address flush dev eth0
  doctor --only interface --interface eth0 && fail "it is content"
  found interface broken "eth0 has no IPv4 address"
  "${inside[@]}" ip link set eth0 down
  doctor --only interface --interface eth0 && fail "it is content"
  found interface broken "eth0 is down"
  paste "$(remedies)"
  "${inside[@]}" ip link show up | has_line eth0
}

test_doctor_tells_of_a_small_mtu() {
  on_a_host
  "${inside[@]}" ip link set eth0 mtu 1280
  doctor --only mtu --interface eth0 || fail "a warning is no failure"
  found mtu warning "1280 bytes"
  is_mended mtu --interface eth0
}

test_doctor_tells_of_a_network_without_multicast() {
  on_a_host
  doctor --only multicast --interface eth0
  found multicast ok "takes multicast"
  "${inside[@]}" ip route del default
  doctor --only multicast --interface eth0
  found multicast warning "there is no route to 239.255.0.1"
  is_mended multicast --interface eth0
  "${inside[@]}" ip link set eth0 multicast off
  doctor --only multicast --interface eth0
  found multicast warning "eth0 takes no multicast"
  paste "$(remedies)"
  "${inside[@]}" ip link show eth0 | has_line MULTICAST
}

# hold_port KIND PORT: a program on the host has it; its id is $!.
hold_port() {
  mkfifo "$scratch/holds-$1-$2"
  "${inside[@]}" python3 -c "
import signal, socket
s = socket.socket(type=socket.SOCK_$1)
s.bind(('0.0.0.0', $2))
if '$1' == 'STREAM': s.listen()
print('ready', flush=True)
signal.pause()" > "$scratch/holds-$1-$2" &
  echo $! >> "$scratch/pids"
  read -r _ < "$scratch/holds-$1-$2"
}

test_doctor_names_who_has_a_port_of_the_node() {
  on_a_host
  doctor --only ports --interface eth0 || fail "$(cat "$scratch/found")"
  found ports ok "tcp port 8420 is free"
  hold_port STREAM 8420
  doctor --only ports --interface eth0 && fail "it is content"
  found ports broken "tcp port 8420 is taken by pid $! (python3)"
  paste "$(remedies)" | has_line 'python3 -c' || fail "$(remedies)"
  kill $!
  tail --pid=$! -f /dev/null
  doctor --only ports --interface eth0 || fail "$(cat "$scratch/found")"
  hold_port DGRAM 11811
  doctor --only ports --interface eth0 || fail "a member takes another port"
  found ports warning "udp port 11811 is taken by pid $! (python3)"
}

test_doctor_knows_a_node_by_its_port_that_it_was_not_told_of() {
  on_a_host
  http_port=8420
  start_node arm --interface eth0
  doctor --only ports --interface eth0 || fail "$(cat "$scratch/found")"
  found ports warning "node 'arm' has them, at 10.231.7.1:8420"
  expect "remedy" "$(remedies)" "roscell doctor --to 10.231.7.1:8420"
}

test_doctor_tells_of_ports_that_any_program_may_get() {
  on_a_host
  doctor --only dds-ports
  found dds-ports ok "none of ROSCell's"
  "${inside[@]}" sysctl -qw net.ipv4.ip_local_port_range="8000 33000" \
    net.ipv4.ip_local_reserved_ports=9000-9010
  doctor --only dds-ports
  found dds-ports warning "with 32150-32166,8420,11811 of ROSCell"
  is_mended dds-ports
}

# let_in: what lets a node in, whether something drops its packets or not.
let_in() {
  jq -r '.[].remedy' "$scratch/found"
}

test_doctor_tells_of_a_firewall_and_lets_a_node_in() {
  on_a_host
  doctor --only firewall --interface eth0
  found firewall ok "no rule of nftables drops what arrives"
  "${inside[@]}" nft -f - << RULES
table inet house {
  chain door {
    type filter hook input priority 0; policy drop;
    ct state established,related accept
  }
}
RULES
  doctor --only firewall --interface eth0 || fail "$(cat "$scratch/found")"
  found firewall skipped "nftables filters what arrives (inet house door, policy drop)"
  paste "$(let_in)"
  "${inside[@]}" nft list chain inet house door > "$scratch/rules"
  has_line 'tcp dport 8420 accept$' < "$scratch/rules" \
    || fail "$(cat "$scratch/rules")"
  has_line 'udp dport { 7490-7649, 8420, 11811, 32150-32166 } accept$' \
    < "$scratch/rules" || fail "$(cat "$scratch/rules")"
  "${inside[@]}" nft flush ruleset
  "${inside[@]}" nft -f - << RULES
table ip filter {
  chain INPUT {
    type filter hook input priority 0; policy drop;
    jump ufw-user-input
  }
  chain ufw-user-input {
    tcp dport 8420 accept
  }
}
RULES
  doctor --only firewall --interface eth0 || fail "$(cat "$scratch/found")"
  let_in | has_line '^sudo ufw allow 8420/tcp && sudo ufw allow 8420,.*/udp$' \
    || fail "$(let_in)"
  "${inside[@]}" nft flush ruleset
  command -v iptables > /dev/null || return 0
  "${inside[@]}" iptables -A INPUT -p udp --dport 11811 -j REJECT
  doctor --only firewall --interface eth0 || fail "$(cat "$scratch/found")"
  found firewall skipped "nftables filters what arrives (ip filter INPUT)"
  "${inside[@]}" iptables -F
  command -v iptables-legacy > /dev/null || return 0
  "${inside[@]}" iptables-legacy -A INPUT -p udp -j DROP
  doctor --only firewall --interface eth0 || fail "$(cat "$scratch/found")"
  found firewall skipped "there are rules of iptables-legacy"
  expect "findings" "$(jq length "$scratch/found")" 1
}

test_doctor_does_not_guess_what_it_may_not_see() {
  on_a_host
  inside+=(setpriv --reuid=65534 --clear-groups)
  doctor --only firewall || fail "$(cat "$scratch/found")"
  found firewall skipped "only root may list its rules"
  inside=(env PATH=/nowhere)
  doctor --only firewall || fail "$(cat "$scratch/found")"
  found firewall skipped 'there is no program `nft`'
}

test_doctor_says_what_the_kernel_gives_a_socket() {
  doctor --only buffers
  if [[ $(< /proc/sys/net/core/rmem_max) -ge 8388608
    && $(< /proc/sys/net/core/wmem_max) -ge 8388608 ]]; then
    found buffers ok "8 MiB to receive"
  else
    found buffers warning "of 8 MiB that skills ask for"
  fi
}

test_doctor_tells_of_sockets_that_hold_no_image() {
  with_bent_host SOCKET_BYTES=8388608 doctor --only buffers
  found buffers ok "a socket gets 8 MiB to receive and 8 MiB to send"
  with_bent_host SOCKET_BYTES=212992 doctor --only buffers
  found buffers warning "a socket gets 208 KiB to receive and 208 KiB to send"
}

# with_mounts COMMANDS: what follows is in a mount namespace where these were
# done before.
with_mounts() {
  [[ $(id -u) -eq 0 ]] || skip "mount namespaces need root"
  inside=(unshare -m --propagation private bash -ec "$1; exec \"\$@\"" -)
}

# with_shm OPTIONS [COMMANDS]: /dev/shm is one of its own.
with_shm() {
  with_mounts "mount -t tmpfs -o $1 tmpfs /dev/shm; ${2:-:}"
}

# mends_shm OPTIONS COMMANDS: the remedy does, too.
mends_shm() {
  with_shm "$1" "$2; $(remedies | sed 's/sudo //')"
  doctor --only shm
  found shm ok "free in /dev/shm"
}

test_doctor_tells_of_shared_memory_that_is_full_small_closed_or_none() {
  with_shm mode=1777,size=256m
  doctor --only shm || fail "$(cat "$scratch/found")"
  found shm ok "are free in /dev/shm"
  local fill='head -c 256M /dev/zero > /dev/shm/full || true'
  with_shm mode=1777,size=256m "$fill 2> /dev/null"
  doctor --only shm && fail "it is content"
  found shm broken "0 B of 256 MiB"
  mends_shm mode=1777,size=256m "$fill 2> /dev/null"
  with_shm mode=1777,size=64m
  doctor --only shm
  found shm warning "64 MiB of 64 MiB"
  mends_shm mode=1777,size=64m :
  with_shm mode=755
  doctor --only shm
  found shm warning "not open to all users"
  mends_shm mode=755 :
  with_shm ro
  doctor --only shm && fail "it is content"
  found shm broken "cannot write to /dev/shm"
  mends_shm ro :
}

test_doctor_removes_from_shared_memory_what_nobody_uses_and_no_more() {
  local shm=/dev/shm/fastrtps_ fill
  fill="touch ${shm}dead ${shm}dead_el ${shm}live ${shm}live_el
    touch ${shm}port7 ${shm}port7_el ${shm}port7_sl /dev/shm/other
    touch /dev/shm/sem.fastrtps_port7_mutex
    exec 8< ${shm}live_el 9< ${shm}port7_sl; flock 8; flock -s 9
    # What anybody may put there.
    touch '${shm}\$(touch run)_el'
    mkfifo ${shm}pipe ${shm}pipe_el"
  with_shm mode=1777 "$fill"
  doctor --only leftovers
  found leftovers warning "2 files of Fast DDS that nobody uses"
  expect "remedies" "$(remedies)" "rm -f ${shm}dead ${shm}dead_el"
  with_shm mode=1777 "$fill; $(remedies)"
  doctor --only leftovers
  found leftovers ok "no memory of Fast DDS is left over, or closed"
}

test_doctor_tells_of_ros_2_programs_of_users_that_cannot_share_memory() {
  [[ $(id -u) -eq 0 ]] || skip "mount namespaces need root"
  local run="'$ROSCELL_BUILD/bin/stock_program' std_msgs/msg/String"
  local other="setpriv --reuid 65534 --regid 65534 --clear-groups"
  with_shm mode=1777 "exec 7< <(exec $run) 8< <(exec $run)
    read -r said <&7; read -r said <&8"
  doctor --only leftovers || fail "$(cat "$scratch/found")"
  found leftovers ok "no memory of Fast DDS is left over, or closed"
  with_shm mode=1777 "exec 7< <(exec $run) 8< <(exec $other $run)
    read -r said <&7; read -r said <&8"
  doctor --only leftovers || fail "$(cat "$scratch/found")"
  found leftovers warning "programs of Fast DDS of users root, nobody"
}

test_doctor_finds_what_a_killed_ros_2_program_leaves_in_shared_memory() {
  with_shm mode=1777 "exec 7< <(exec '$ROSCELL_BUILD/bin/stock_program' std_msgs/msg/String)
    read -r said <&7
    '$ROSCELL' doctor -o json --only leftovers > '$scratch/living'
    kill -9 \$!; read -r said <&7 || true"
  doctor --only leftovers
  found leftovers warning "files of Fast DDS that nobody uses"
  remedies | has_line /dev/shm/sem.fastrtps_port
  jq -e 'all(.[]; .verdict == "ok")' "$scratch/living" > /dev/null \
    || fail "of a living one: $(cat "$scratch/living")"
}

test_doctor_tells_of_a_data_directory_that_is_full_closed_or_read_only() {
  local folder=$scratch/data
  mkdir "$folder"
  doctor --only disk,fsync || fail "$(cat "$scratch/found")"
  found fsync ok "4 KiB are kept in"
  with_mounts "mount -t tmpfs -o size=64k tmpfs $folder
    head -c 64k /dev/zero > $folder/full"
  doctor --only disk,fsync && fail "it is content"
  found disk broken "0 B are free in $folder"
  found fsync skipped "nothing can be written"
  with_mounts "mount -t tmpfs -o ro,size=2g tmpfs $folder"
  doctor --only disk && fail "it is content"
  found disk broken "Read-only file system"
  with_mounts "mount -t tmpfs -o ro,size=2g tmpfs $folder
    $(remedies | sed 's/sudo //')"
  doctor --only disk || fail "$(cat "$scratch/found")"
  chmod 755 "$scratch"
  inside=(setpriv --reuid=65534 --clear-groups)
  doctor --only disk && fail "it is content"
  found disk broken "this user cannot write to $folder: Permission denied"
  # Whose it is may be meant: nothing is said to take it away from them.
  expect "remedy" "$(remedies)" "ls -ld $folder && id"
}

test_doctor_tells_of_a_disk_that_is_slow_to_keep_what_is_written() {
  mkdir "$scratch/data"
  doctor --only fsync || fail "$(cat "$scratch/found")"
  found fsync ok "4 KiB are kept in"
  with_bent_host FSYNC_MS=80 doctor --only fsync \
    || fail "$(cat "$scratch/found" "$scratch/doctor.err")"
  found fsync warning "4 KiB are kept in"
}

test_doctor_tells_of_a_clock_that_nothing_synchronises_or_that_may_be_wrong() {
  mkdir "$scratch/data"
  with_bent_host CLOCK_ERROR_US=-1 doctor --only clock
  found clock warning "nothing synchronises the clock"
  with_bent_host CLOCK_ERROR_US=2000000 doctor --only clock
  found clock warning "is synchronised, and wrong by 2000 ms at most"
  with_bent_host CLOCK_ERROR_US=3000 doctor --only clock
  found clock ok "is synchronised, and wrong by 3 ms at most"
}

test_doctor_tells_of_few_file_descriptors() {
  inside=(prlimit --nofile=100:100)
  doctor --only descriptors && fail "it is content"
  found descriptors broken "may open 100 files"
}

# listen_at SOCKET [WORDS]: somebody listens there, and says no more than that.
listen_at() {
  mkfifo "$1.ready"
  python3 -c "
import signal, socket
s = socket.socket(socket.AF_UNIX)
s.bind('$1')
s.listen()
print('ready', flush=True)
signal.pause()" > "$1.ready" &
  echo $! >> "$scratch/pids"
  read -r _ < "$1.ready"
}

test_doctor_tells_why_a_container_engine_cannot_be_used() {
  local socket=$scratch/docker.sock
  echo "runtime = docker:$socket" > "$scratch/node.conf"
  doctor --config "$scratch/node.conf" --only engine && fail "it is content"
  found engine broken "there is no socket '$socket'"
  listen_at "$socket"
  doctor --config "$scratch/node.conf" --only engine && fail "it is content"
  found engine broken "does not answer"
  chmod 755 "$scratch"
  chmod 600 "$socket"
  inside=(setpriv --reuid=65534 --clear-groups)
  doctor --config "$scratch/node.conf" --only engine && fail "it is content"
  found engine broken "no permission to use"
  expect "remedy" "$(remedies)" 'sudo usermod -aG docker nobody'
  inside=()
  kill "$(tail -1 "$scratch/pids")"
  tail --pid="$(tail -1 "$scratch/pids")" -f /dev/null
  doctor --config "$scratch/node.conf" --only engine && fail "it is content"
  found engine broken "does not run"
  echo "runtime = process" > "$scratch/node.conf"
  doctor --config "$scratch/node.conf" --only engine || fail "$(cat "$scratch/found")"
  found engine skipped "wanted as processes"
}

test_doctor_tells_what_of_a_gpu_is_missing() {
  local dev=$scratch/dev
  mkdir -p "$dev" "$scratch/lib"
  cp -a /dev/null /dev/zero /dev/urandom /dev/random "$dev"
  mknod "$dev/nvidia0" c 1 3 && chmod 666 "$dev/nvidia0"
  mkdir "$dev/shm"
  with_mounts "mount --bind $dev /dev"
  doctor --only gpu
  found gpu warning "no libnvidia-ml.so.1"
  inside=(env "LD_LIBRARY_PATH=$scratch/lib" "${inside[@]}")
  ln -s "$ROSCELL_BUILD/test/libfake_nvml.so" "$scratch/lib/libnvidia-ml.so.1"
  doctor --only gpu
  found gpu ok "Fake GPU 0"
  command -v cc > /dev/null || skip "there is no C compiler"
  rm "$scratch/lib/libnvidia-ml.so.1"
  cc -shared -fPIC -x c -o "$scratch/lib/libnvidia-ml.so.1" - << SOURCE
int nvmlInit_v2(void) { return 18; }
int nvmlShutdown(void) { return 0; }
const char *nvmlErrorString(int code) { return "Driver/library version mismatch"; }
SOURCE
  doctor --only gpu && fail "it is content"
  found gpu broken "Driver/library version mismatch"
}

test_doctor_tells_of_another_fast_dds_than_it_was_built_with() {
  local real
  real=$(ldd "$ROSCELL" | awk '$1 ~ /^libfastrtps/ {print $3}')
  mkdir "$scratch/lib"
  cp "$(realpath "$real")" "$scratch/lib/libfastrtps.so.2.9.99"
  ln -s libfastrtps.so.2.9.99 "$scratch/lib/$(basename "$real")"
  doctor --only versions
  found versions ok "Fast DDS 2"
  inside=(env "LD_LIBRARY_PATH=$scratch/lib")
  doctor --only versions
  found versions warning "libfastrtps.so.2.9.99"
}

test_doctor_tells_of_skills_that_cannot_be_loaded() {
  mkdir "$scratch/data"
  cp -r "$skills" "$scratch/data/skills"
  doctor --only skills || fail "$(cat "$scratch/found")"
  found skills ok "1 can be loaded"
  rm "$scratch/data/skills/echo/bin/echo"
  doctor --only skills && fail "it is content"
  found skills broken "bin/echo"
  [[ $(remedies) == "roscell skill check "* ]] || fail "$(remedies)"
}

test_doctor_tells_of_skills_whose_libraries_or_interpreter_are_missing() {
  mkdir "$scratch/data"
  cp -r "$skills" "$scratch/data/skills"
  cp "$ROSCELL_BUILD/bin/lacking" "$scratch/data/skills/echo/bin/echo"
  doctor --only skills && fail "it is content"
  found skills broken "this node does not have libgone.so"
  printf '#!/nowhere/python3\n' > "$scratch/data/skills/echo/bin/echo"
  echo "runtime = process" > "$scratch/node.conf"
  doctor --config "$scratch/node.conf" --only skills && fail "it is content"
  found skills broken "this node does not have '/nowhere/python3'"
}

# doctor_here OPTION...: with nothing named but what the options name.
doctor_here() {
  env -u ROSCELL_TO "$ROSCELL" doctor -o json "$@" > "$scratch/found" \
    2> "$scratch/doctor.err"
}

test_doctor_takes_what_a_node_has_from_the_node() {
  mkdir -m 755 "$scratch/run"
  start_node head --coordinator --interface lo --domain-id 7 \
    --socket "$scratch/run/node.sock"
  doctor_here --to "$scratch/run/node.sock" || fail "$(cat "$scratch/found")"
  found disk ok "are free in $scratch/head"
  found dds-ports ok "in domain 7 are in use"
  found skills ok "1 can be loaded"
  jq -e --arg run "$scratch/run" 'all(.[]; (.seen + .remedy) | contains($run)
    | not)' "$scratch/found" > /dev/null || fail "$(cat "$scratch/found")"
  # It is the node that cannot do without its program.
  rm "$skills/echo/bin/echo"
  doctor_here --to "$scratch/run/node.sock" --only skills && fail "it is content"
  found skills broken "bin/echo"
}

test_doctor_with_cell_tells_what_it_found_where_no_node_answers() {
  doctor --cell --only clock,shm
  expect "exit code" $? 1
  found reach broken "cannot connect"
  jq -e 'any(.[]; .check == "shm")' "$scratch/found" > /dev/null \
    || fail "$(cat "$scratch/found" "$scratch/doctor.err")"
}

test_doctor_without_threads_says_what_it_could_not_begin() {
  [[ $(id -u) -eq 0 ]] || skip "another user needs root"
  chmod 755 "$scratch"
  inside=(setpriv --reuid=65533 --clear-groups prlimit --nproc=1:1)
  doctor --only descriptors,shm
  found descriptors skipped "it could not be begun"
}

test_doctor_tells_of_a_node_that_still_is_of_an_older_program() {
  local version other
  version=$("$ROSCELL" --version | cut -d' ' -f2)
  other=${version%?}x
  LC_ALL=C sed "s/${version//./[.]}/$other/g" "$ROSCELL" > "$scratch/roscell"
  chmod +x "$scratch/roscell"
  start_node head --coordinator --interface lo
  doctor --to "$scratch/head/node.sock" --only node-version
  found node-version ok "head is of version $version"
  ROSCELL=$scratch/roscell doctor --to "$scratch/head/node.sock" \
    --only node-version || fail "$(cat "$scratch/found" "$scratch/doctor.err")"
  found node-version warning "head is of version $version"
  found node-version warning "this program is of $other"
}

test_doctor_tells_of_instances_that_have_failed_or_starve() {
  local instance
  start_node head --coordinator --interface lo
  echo_task t | jq '.pipeline[0] += {"restart": {"policy": "never"},
      "health": {"inputs": {"max_age_s": 0.2}, "grace_s": 0.2}}' \
    | to head request > "$scratch/reply.json" || fail "$(cat "$scratch/reply.json")"
  instance=$(jq -r '.instances[0].instance' "$scratch/reply.json")
  await head '.event == "instance_starved"' > /dev/null
  doctor --to "$scratch/head/node.sock" --only instances
  found instances warning "$instance is starved"
  pkill -KILL -P "$(readlink "$scratch/head/instances/$instance/pid" | cut -d' ' -f1)"
  await head ".event == \"instance_changed\" and .data.state == \"failed\"" \
    > /dev/null
  doctor --to "$scratch/head/node.sock" --only instances && fail "it is content"
  found instances broken "$instance has failed"
}

test_doctor_asks_the_node_and_tells_who_is_away() {
  start_node head --coordinator --cell line --interface lo
  doctor --to "$scratch/head/node.sock" || fail "$(cat "$scratch/found")"
  found node-version ok "head is of version"
  found joining ok "head is in cell line"
  found cell ok "1 nodes are in cell line"
  found topics ok "have ends that match"
  found ports ok "in use by the node"
  doctor --to "$(get head /v1/node | jq -r .identity.address)" --only clock \
    && fail "it needs no token"
  found node broken "the bearer token is missing or wrong"
  inside=(env -u ROSCELL_TO)
  data=head
  doctor --only node-version
  found node-version ok "head is of version"
  start_node arm --interface lo --join "$(discovery_of head)"
  await_joined head arm
  kill -9 "${pid[arm]}"
  await head '.event == "node_lost"' > /dev/null
  doctor --to "$scratch/head/node.sock" --only cell && fail "it is content"
  found cell broken "arm is lost"
}

test_doctor_tells_of_a_node_that_does_not_come_into_its_cell() {
  rm "$skills/echo/bin/echo"
  start_node arm --interface lo --join 127.0.0.1:9
  await arm '.event == "join_failed"' > /dev/null
  doctor --to "$scratch/arm/node.sock" && fail "it is content"
  found joining broken "arm does not come into 127.0.0.1:9"
  found refused-skills broken "bin/echo"
}

test_doctor_with_nobody_there_or_wrong_words() {
  doctor --to "$scratch/none.sock" --only clock && fail "it is content"
  found node broken "cannot connect"
  doctor --only moon
  expect "exit code" $? 2
  echo "interfac = lo" > "$scratch/node.conf"
  doctor --config "$scratch/node.conf"
  expect "exit code" $? 2
  has_line "did you mean 'interface'" "$scratch/doctor.err"
}

units=tools/roscell/service

test_the_units_have_taken_away_what_a_node_does_not_need() {
  command -v systemd-analyze > /dev/null || skip "systemd-analyze is missing"
  local unit level
  for unit in roscell.service roscell@.service; do
    # An instance of a template has a name.
    cp "$units/$unit" "$scratch/${unit/@/@arm}"
    systemd-analyze security --offline=true --threshold=40 --no-pager \
      "$scratch/${unit/@/@arm}" > "$scratch/said" 2>&1 \
      || fail "$unit: $(tail -n 2 "$scratch/said")"
  done
  level=$(grep -o 'Overall exposure level.*: [0-9.]*' "$scratch/said" | grep -o '[0-9.]*$')
  grep -q "Overall exposure level for roscell.service: $level" docs/service.md \
    || fail "docs/service.md has another level than $level"
}

test_the_manual_has_the_unit_as_it_is() {
  sed -n '/^```ini$/,/^```$/{/^```/!p}' docs/service.md \
    | sed '/^WantedBy=multi-user.target$/q' > "$scratch/said"
  diff "$scratch/said" "$units/roscell.service" \
    || fail "docs/service.md has another unit"
}
