# The part "cell" of overhead_bench.sh: a coordinator and $members members, each alone
# on a host. To be sourced; what it prints is gathered over $rounds cells.

in_s=300
most_sampled=20
single_starts=5

# All hosts share one kernel's table of neighbours, which two entries for each of 250
# members overflow at times: then single hosts reach nobody for half a minute.
neighbours=/proc/sys/net/ipv4/neigh/default/gc_thresh
set_neighbours() {
  echo "$3" > ${neighbours}3
  echo "$2" > ${neighbours}2
  echo "$1" > ${neighbours}1
}

# launch I: a member on host I, which waits for the gate, so that all start at one
# moment whatever it takes to make so many processes.
launch() {
  local name=node$1
  ip netns exec "${hosts[$1 - 1]}" flock --no-fork -s "$scratch/gate" \
    "$ROSCELL" node --name "$name" --data-dir "$scratch/$name" \
    --interface "10.231.7.$1" --site-token "$scratch/site.token" \
    --skills "$skills" --public-domain "$public_domain" --runtime process \
    --join "$(< "$scratch/server")" 2> "$scratch/$name.log" &
  pid[$name]=$!
  echo "${pid[$name]}" >> "$scratch/pids"
}

# await_all_joined: when the coordinator has told of each of them, in $scratch/joined.
await_all_joined() {
  local events reader
  exec {events}< <(exec "$ROSCELL" events --to "$scratch/head/node.sock" --since 0 \
    -o json 2> "$scratch/events.err")
  reader=$!
  timeout "$in_s" grep -m "$members" . > "$scratch/joined" < <(exec jq --unbuffered \
    'select(.event == "node_joined" and .subject != "head") | .time_unix_ms' \
    <&"$events")
  kill "$reader" 2> /dev/null
  exec {events}<&-
  [[ $(wc -l < "$scratch/joined") -eq $members ]] \
    || fail "$(wc -l < "$scratch/joined") of $members have joined after $in_s s"
}

await_all_in() {
  local end=$((SECONDS + in_s))
  until [[ $(get head /metrics \
    | sed -n 's/^roscell_discovery_participants{kind="server"} //p') == "$members" ]]; do
    [[ $SECONDS -lt $end ]] \
      || fail "discovery does not know all of $members after $in_s s"
    timeout 0.05 tail -f /dev/null
  done
}

cpu_s_of() {
  local name
  for name in "$@"; do cpu_ns "$name"; done | awk '{sum += $1} END {print sum / 1e9}'
}

start_cell() {
  local i gate begin names=() head_cpu_s
  begin=$(now_ms)
  start_on 1 head --coordinator --cell line
  figure "coordinator: start to ready" $(($(now_ms) - begin)) ms
  discovery_of head > "$scratch/server"
  exec {gate}> "$scratch/gate"
  flock -x "$gate"
  for ((i = 2; i <= members + 1; ++i)); do
    launch "$i"
    names+=("node$i")
  done
  head_cpu_s=$(cpu_s_of head)
  begin=$(now_ms)
  flock -u "$gate"
  exec {gate}>&-
  await_all_joined
  figure "all of $members members: start to joined" \
    $(($(tail -n 1 "$scratch/joined") - begin)) ms
  await_all_in
  figure "all of $members members: start to in" $(($(now_ms) - begin)) ms
  figure "all of $members members: CPU until all are in" "$(cpu_s_of "${names[@]}")" s
  figure "coordinator: CPU until all are in" \
    "$(jq -n "$(cpu_s_of head) - $head_cpu_s")" s
}

name_of() {
  [[ $1 == 1 ]] && echo head || echo "node$1"
}

role_of() {
  [[ $1 == 1 ]] && echo coordinator || echo member
}

# counters I: all that grows, in one line. What a host sends its cable's other end
# receives, where it costs no process in the namespace to read.
counters() {
  local name wire
  name=$(name_of "$1")
  wire=/sys/class/net/$(host_link "$1")/statistics
  {
    cpu_ns "$name"
    awk '$1 == "write_bytes:" {print $2}' "/proc/${pid[$name]}/io"
    cat "$wire"/{rx_bytes,tx_bytes,rx_packets,tx_packets}
  } | paste -sd,
}

# rates I BEFORE AFTER: what has grown; of the coordinator also for each member.
rates() {
  jq -nc --arg role "$(role_of "$1")" --argjson before "[$2]" --argjson after "[$3]" \
    --argjson s "$span_s" --argjson members "$members" '
    [["CPU", "% of a core", 1e7], ["written to the disk", "B/s", 1], ["sent", "B/s", 1],
     ["received", "B/s", 1], ["packets sent", "1/s", 1], ["packets received", "1/s", 1]]
    | to_entries[] | .key as $i | .value as [$name, $unit, $per]
    | {figure: "\($role), idle: \($name)", $unit,
       value: (($after[$i] - $before[$i]) / $per / $s)}
    | ., (select($role == "coordinator" and ($i | IN(0, 2, 3)))
          | .figure += ", for each member" | .value /= $members)'
}

idle_metrics() {
  local i kind before=()
  for i in "${sampled[@]}"; do before[i]=$(counters "$i"); done
  timeout "$span_s" tail -f /dev/null
  for i in "${sampled[@]}"; do
    rates "$i" "${before[i]}" "$(counters "$i")"
    for kind in Pss Rss Private_Dirty; do
      figure "$(role_of "$i"): $kind" \
        "$(jq -n "$(memory_kib "$(name_of "$i")" "$kind") / 1024")" MiB
    done
  done
}

# start_single_ones: nodes that come one by one, and a task.
start_single_ones() {
  local i begin joined
  for ((i = 1; i <= single_starts; ++i)); do
    begin=$(now_ms)
    start_on $((members + 2)) "late$i" --join "$(< "$scratch/server")"
    joined=$(await head ".event == \"node_joined\" and .subject == \"late$i\"" \
      | jq .time_unix_ms)
    figure "a member alone: start to joined" $((joined - begin)) ms
    stop_node "late$i"
    unset "pid[late$i]"
    figure "request to running, as a process" "$(run_task head "bench$i")" ms
  done
}

end_cell() {
  local i name
  kill -TERM "${pid[@]}"
  for name in "${!pid[@]}"; do
    timeout "$deadline_s" tail --pid="${pid[$name]}" -f /dev/null \
      || fail "node $name did not end"
  done
  for i in "${sampled[@]}"; do
    figure "$(role_of "$i"): data directory" \
      "$(jq -n "$(du -sk "$scratch/$(name_of "$i")" | cut -f 1) / 1024")" MiB
  done
  for name in "${!pid[@]}"; do rm -r "${scratch:?}/$name"; done
  pid=()
}

cell_part() {
  local round
  before_bench=("$(< ${neighbours}1)" "$(< ${neighbours}2)" "$(< ${neighbours}3)")
  bridge_hosts $((members + 2))
  trap 'set_neighbours "${before_bench[@]}"; clean_up 2> /dev/null; rm -rf "$scratch"' EXIT
  set_neighbours 4096 8192 16384
  use_skills
  make_site_token
  mapfile -t sampled < <(echo 1
    seq 2 $(((members + most_sampled - 1) / most_sampled)) $((members + 1)))
  for ((round = 1; round <= rounds; ++round)); do
    start_cell
    [[ $rest_s == 0 ]] || timeout "$rest_s" tail -f /dev/null
    idle_metrics
    start_single_ones
    end_cell
  done > "$scratch/all.jsonl"
  jq -sc --argjson s "$span_s" 'group_by(.figure)[] | sort_by(.value)
    | .[((length - 1) / 2 | floor)]
      + {least: .[0].value, most: .[-1].value, of: length, seconds: $s}' \
    "$scratch/all.jsonl"
}
