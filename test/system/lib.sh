# What the system tests share: real nodes as processes, alone on loopback or in
# network namespaces. Nothing here polls: nodes tell when they are ready, and
# changes are read from the event stream, each with a deadline.

: "${ROSCELL_BUILD:?the build directory}"
ROSCELL=$ROSCELL_BUILD/bin/roscell
# What a user's nodes share on one host: here it is the test's own.
export ROSCELL_SITE_TOKEN=$scratch/user/site.token
deadline_s=${ROSCELL_DEADLINE_S:-60}

fail() {
  echo "    $*" >&2
  exit 1
}

skip() {
  echo "$*" > "$scratch/skipped"
  exit 77
}

need_namespaces() {
  [[ $(id -u) -eq 0 ]] || skip "network namespaces need root"
  { ip netns add "roscell-probe-$$" && ip netns exec "roscell-probe-$$" true; } \
    2> /dev/null || skip "network namespaces cannot be made here"
  ip netns del "roscell-probe-$$"
}

# start_node NAME [OPTION...]: starts a node and waits until it is ready. Its
# process id is in ${pid[NAME]}. $inside may hold a command prefix such as
# `ip netns exec NAME`.
declare -A pid
inside=()
runtime=process
discovery_port=0
http_port=0
# Nodes of one test see each other, and no others on this machine.
public_domain=$((20 + BASHPID % 200))
start_node() {
  local name=$1 ready=$scratch/$1.ready
  shift
  rm -f "$ready"
  mkfifo "$ready"
  "${inside[@]}" "$ROSCELL" node --name "$name" --data-dir "$scratch/$name" \
    --port "$http_port" --discovery-port "$discovery_port" --skills "$skills" \
    --public-domain "$public_domain" \
    --runtime "$runtime" \
    --ready-fd 5 "$@" 5> "$ready" 2>> "$scratch/$name.log" &
  pid[$name]=$!
  echo "${pid[$name]}" >> "$scratch/pids"
  # Only the node holds the other end, so its end is the end of the wait, too.
  local said=
  read -r -t "$deadline_s" said < "$ready" || true
  [[ -n $said ]] \
    || fail "node $name did not start: $(tail -3 "$scratch/$name.log")"
}

# use_skills [NAME...]: the skills that nodes of a test have; echo if none is
# named. They ask for no CPU, so that a test does not depend on what else this
# machine is doing, and for no memory, of which a sanitizer takes more than any
# skill asks for.
use_skills() {
  local name
  skills=$scratch/skills
  mkdir "$skills"
  for name in "${@:-echo}"; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
}

ask_no_cpu() {
  local text
  text=$(jq '.models[].deployments[].resources |= (.cpu = 0 | .memory_mib = 0)' \
    "$1/skill.json")
  echo "$text" > "$1/skill.json"
}

# to NAME COMMAND...: a client command, spoken to that node.
to() {
  local name=$1 command=$2
  shift 2
  "$ROSCELL" "$command" --to "$scratch/$name/node.sock" "$@"
}

# get NAME PATH: the JSON of a REST path, by the node's Unix socket.
get() {
  curl -sS --max-time "$deadline_s" \
    --unix-socket "$scratch/$1/node.sock" "http://node$2"
}

discovery_of() {
  get "$1" /v1/cell | jq -r .discovery_server
}

# await NAME FILTER [SINCE]: waits until an event of that node matches the jq
# filter, and prints it.
await() {
  local line= events matching reader
  exec {events}< <(exec "$ROSCELL" events --to "$scratch/$1/node.sock" \
                     --since "${3:-0}" -o json 2> "$scratch/events.err")
  reader=$!
  exec {matching}< <(exec jq --unbuffered -c "select(($2)? // false)" <&"$events")
  read -r -t "$deadline_s" line <&"$matching" || true
  kill "$reader" 2> /dev/null
  exec {events}<&- {matching}<&-
  [[ -n $line ]] || fail "no event of $1 with: $2 $(cat "$scratch/events.err")"
  echo "$line"
}

await_joined() {
  await "$1" ".event == \"node_joined\" and .subject == \"$2\"" "${3:-0}" \
    > /dev/null
}

# await_anew NAME ADDRESS: until its node is made anew there.
await_anew() {
  local anew
  anew=$(grep -c "listens on $2:" "$scratch/$1.log")
  timeout "$deadline_s" grep -m $((anew + 1)) "listens on $2:" \
    > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +1 -F "$scratch/$1.log" 2> /dev/null) \
    || fail "$1 is not made anew: $(tail -n 3 "$scratch/$1.log")"
}

row_state() {
  get "$1" /v1/cell \
    | jq -r ".nodes[] | select(.identity.name == \"$2\") | .state"
}

# stop_node NAME [SIGNAL]: ends a node and waits for its end.
stop_node() {
  kill "-${2:-TERM}" "${pid[$1]}"
  timeout "$deadline_s" tail --pid="${pid[$1]}" -f /dev/null \
    || fail "node $1 did not end"
}

# echo_task TASK [NODE]: a request that runs the echo skill, following a file.
echo_task() {
  mkdir -p "$scratch/data"
  touch "$scratch/data/$1.in"
  jq -n --arg task "$1" --arg dir "$scratch/data" --arg node "${2:-}" '
    {type: "task_request", task: $task, pipeline: [
      {id: "say", operation: "echo", model: "plain",
       input: {protocol: "file", endpoint: ($dir + "/" + $task + ".in"),
               data_type: "text/plain"},
       output: {protocol: "file", endpoint: ($dir + "/" + $task + ".out"),
                data_type: "text/plain"}}
      + (if $node == "" then {} else {labels: {place: $node}} end)]}'
}

# run_on NODE TASK: a step of echo on that node, which has a label place.
run_on() {
  echo_task "$2" "$1" > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" \
    || fail "refused: $(cat "$scratch/reply.json")"
  expect "the node" "$(jq -r '.instances[0].node' "$scratch/reply.json")" "$1"
}

# lines_come TASK WORD [PREFIX]: some lines that are given to its step come out,
# with what the build puts before them.
lines_come() {
  local n
  for n in 1 2 3 4 5; do
    echo "$2 $n" >> "$scratch/data/$1.in"
  done
  for n in 1 2 3 4 5; do
    timeout "$deadline_s" grep -m 1 -x "${3:-}$2 $n" > "$scratch/matches" \
      < <(exec tail --pid=$$ -n +1 -F "$scratch/data/$1.out" 2> /dev/null) \
      || fail "no '${3:-}$2 $n': $(tail -n 3 "$scratch/data/$1.out")"
  done
}

# has_line PATTERN: grep -q that reads on, for who writes into a closed pipe
# fails, and the pipe with it.
has_line() {
  grep "$@" > /dev/null
}

# expect WHAT ACTUAL EXPECTED
expect() {
  [[ $2 == "$3" ]] || fail "$1: expected '$3', got '$2'"
}

# bridge_hosts COUNT: that many hosts in namespaces on one bridge, with the
# addresses 10.231.7.1 ... on eth0; host_link N is the bridge's end of a host's
# cable. The names carry this test's own process id, because the kernel removes
# the interfaces of an earlier test's namespaces only some time after them.
hosts=()
bridge_hosts() {
  need_namespaces
  bridge=rcb$BASHPID
  ip link add "$bridge" type bridge mcast_snooping 0
  ip link set "$bridge" up
  for ((i = 1; i <= $1; ++i)); do
    local host=${bridge/rcb/rc}-$i
    hosts+=("$host")
    ip netns add "$host"
    ip link add "$(host_link "$i")" type veth peer name eth0 netns "$host"
    ip link set "$(host_link "$i")" master "$bridge" up
    ip -n "$host" addr add "10.231.7.$i/24" dev eth0
    ip -n "$host" link set eth0 up
    ip -n "$host" link set lo up
    ip -n "$host" route add default dev eth0
  done
}

host_link() {
  echo "${bridge/rcb/rcv}-$1"
}

# lose_packets PERCENT: so many of the packets that arrive at each host are lost.
# By nftables, because kernels without netem are more common than without it.
lose_packets() {
  local host
  for host in "${hosts[@]}"; do
    ip netns exec "$host" nft -f - 2> /dev/null << RULES ||
table inet loss {
  chain arriving {
    type filter hook input priority 0
    iifname "eth0" numgen random mod 100 < $1 counter drop
  }
}
RULES
      skip "this kernel's nftables cannot lose packets"
  done
}

# bridge_port N: what the bridge has of a host: its cable, or the end of the
# delay line that its cable is led through.
bridge_port() {
  local port=${bridge/rcb/rcd}-$1
  [[ -e /sys/class/net/$port ]] || port=$(host_link "$1")
  echo "$port"
}

# delay_packets MILLISECONDS: what a host sends arrives so much later. By netem
# where the kernel has it, else by a program that all cables are led through.
delay_packets() {
  local host
  for host in "${hosts[@]}"; do
    ip netns exec "$host" tc qdisc add dev eth0 root netem delay "$1ms" \
      limit 10000 2> /dev/null || { lead_through_delay_line "$1"; return; }
  done
}

# shape_links RATE: what each host sends and gets is held to that, each way.
shape_links() {
  local n
  for ((n = 1; n <= ${#hosts[@]}; ++n)); do
    ip netns exec "${hosts[n - 1]}" tc qdisc add dev eth0 root \
      tbf rate "$1" burst 64kb latency 50ms 2> /dev/null \
      && tc qdisc add dev "$(host_link "$n")" root \
        tbf rate "$1" burst 64kb latency 50ms 2> /dev/null \
      || skip "this kernel cannot hold links to a rate"
  done
}

lead_through_delay_line() {
  local n cables=() said=
  { : <> /dev/net/tun; } 2> /dev/null || skip "neither netem nor TAPs here"
  for ((n = 1; n <= ${#hosts[@]}; ++n)); do
    ip link set "$(host_link "$n")" nomaster
    cables+=("$(host_link "$n")" "${bridge/rcb/rcd}-$n")
  done
  mkfifo "$scratch/delay.ready"
  "$ROSCELL_BUILD/bin/delay_line" "$1" "${cables[@]}" \
    > "$scratch/delay.ready" 2> "$scratch/delay_line.log" &
  echo $! >> "$scratch/pids"
  read -r -t "$deadline_s" said < "$scratch/delay.ready"
  [[ $said == ready ]] || fail "$(cat "$scratch/delay_line.log")"
  for ((n = 1; n <= ${#hosts[@]}; ++n)); do
    ip link set "$(bridge_port "$n")" master "$bridge" up
  done
}

# split_bridge N...: from now on these hosts hear each other but none of the
# others, until heal_bridge.
split_bridge() {
  local n
  ip link add "$bridge-far" type bridge mcast_snooping 0
  ip link set "$bridge-far" up
  for n in "$@"; do
    ip link set "$(bridge_port "$n")" master "$bridge-far"
  done
}

heal_bridge() {
  local port
  for port in /sys/class/net/"$bridge-far"/brif/*; do
    ip link set "$(basename "$port")" master "$bridge"
  done
  ip link del "$bridge-far"
}

# loses_nobody NAME SECONDS: whether that coordinator loses no member during
# this time.
loses_nobody() {
  timeout "$2" "$ROSCELL" events --to "$scratch/$1/node.sock" -o json \
    2> /dev/null | grep -m 1 '"node_lost"' > "$scratch/lost.json"
  local code=${PIPESTATUS[0]}
  [[ ! -s $scratch/lost.json ]] || fail "lost: $(cat "$scratch/lost.json")"
  [[ $code -eq 124 ]] || fail "the event stream of $1 ended"
}

# start_on HOST_NUMBER NAME [OPTION...]: a node on one of these hosts.
start_on() {
  local host=${hosts[$(($1 - 1))]} number=$1 name=$2
  shift 2
  inside=(ip netns exec "$host")
  start_node "$name" --interface "10.231.7.$number" \
    --site-token "$scratch/site.token" "$@"
  inside=()
}

# with_bent_host SETTING=VALUE COMMAND...: what it starts finds its host as the
# setting of test/system/hosts/bent_host.cpp says.
with_bent_host() {
  local -x "$1" LD_PRELOAD=$ROSCELL_BUILD/bin/libbent_host.so
  # A sanitizer wants to be the first library.
  local -x ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0
  "${@:2}"
}

make_site_token() {
  head -c 32 /dev/urandom | od -An -tx1 | tr -d ' \n' > "$scratch/site.token"
}

# Everything that a test has started or made goes with it.
clean_up() {
  local what shims=()
  # Who is asked to end twice would leave the hosts that it has made.
  trap '' INT TERM HUP
  [[ -f $scratch/pids ]] && while read -r what; do
    kill -CONT "$what" 2>/dev/null
    kill -KILL "$what" 2>/dev/null
  done < "$scratch/pids"
  for what in "$scratch"/*/instances/*/pid; do
    # A link whose target says it; earlier versions have written a file.
    [[ -L $what || -f $what ]] || continue
    shims+=("$({ readlink "$what" || cat "$what"; } | cut -d' ' -f1)")
    kill -QUIT "${shims[-1]}" 2>/dev/null
  done
  # They write into their folders to their end.
  for what in "${shims[@]}"; do
    timeout 10 tail -s 0.05 --pid="$what" -f /dev/null
  done
  for what in "${hosts[@]}"; do
    ip netns del "$what" 2>/dev/null
  done
  for what in ${bridge:+"$bridge" "$bridge-far"}; do
    ip link del "$what" 2>/dev/null
  done
  jobs -p | xargs -r kill 2>/dev/null
}
