# What nodes use that have nothing to do. To be sourced after on_nodes.sh, in
# namespaces of bridge_hosts: the node names[I] is alone on the host hosts[I].

# A process behind `ip netns exec`, which replaces itself by the node.
# cpu_ns NAME: time that all threads of the node have run.
cpu_ns() {
  cat /proc/"${pid[$1]}"/task/*/schedstat | awk '{sum += $1} END {print sum}'
}

memory_kib() {
  awk -v key="$2:" '$1 == key {print $2}' "/proc/${pid[$1]}/smaps_rollup"
}

# Bytes that the node has had written to the disk.
written_bytes() {
  awk '$1 == "write_bytes:" {print $2}' "/proc/${pid[$1]}/io"
}

# wire I COUNTER: of the only interface of that host.
wire() {
  ip netns exec "${hosts[$1]}" cat "/sys/class/net/eth0/statistics/$2"
}

wire_counters=(tx_bytes rx_bytes tx_packets rx_packets)

# counters I: all that grows, in one line.
counters() {
  local counter
  echo -n "$(cpu_ns "${names[$1]}") $(written_bytes "${names[$1]}")"
  for counter in "${wire_counters[@]}"; do
    echo -n " $(wire "$1" "$counter")"
  done
}

# rate NAME BEFORE AFTER PER UNIT: what has grown, per second and PER.
rate() {
  figure "$1" "$(jq -n "($3 - $2) / $4 / $span_s")" "$5"
}

# idle_figures: figures of all nodes over $span_s seconds.
idle_figures() {
  local i name kind before=() was=() is=()
  for i in "${!names[@]}"; do
    before[i]=$(counters "$i")
  done
  timeout "$span_s" tail -f /dev/null
  for i in "${!names[@]}"; do
    name=${names[i]}
    read -ra was <<< "${before[i]}"
    read -ra is <<< "$(counters "$i")"
    rate "$name: idle CPU" "${was[0]}" "${is[0]}" 1e7 "% of a core over $span_s s"
    rate "$name: written to disk" "${was[1]}" "${is[1]}" 1 B/s
    rate "$name: idle wire" "${was[2]}" "${is[2]}" 1 "B/s sent"
    rate "$name: idle wire, received" "${was[3]}" "${is[3]}" 1 "B/s received"
    rate "$name: packets sent" "${was[4]}" "${is[4]}" 1 1/s
    rate "$name: packets received" "${was[5]}" "${is[5]}" 1 1/s
    for kind in Pss Private_Dirty Rss; do
      figure "$name: $kind" "$(jq -n "$(memory_kib "$name" "$kind") / 1024")" MiB
    done
  done
}
