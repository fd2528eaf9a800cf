# What a node and a cell tell Prometheus.

need_prometheus() {
  command -v promtool > /dev/null && command -v prometheus > /dev/null \
    || skip "Prometheus is not installed"
}

# metrics NAME [ACCEPT]: what the node answers to a scraper.
metrics() {
  curl -sS --max-time "$deadline_s" -H "Accept: ${2:-}" \
    --unix-socket "$scratch/$1/node.sock" http://node/metrics
}

start_line() {
  start_node head --coordinator --cell line --interface lo
  server=$(discovery_of head)
  start_node arm --interface lo --join "$server"
  await_joined head arm
  echo_task t | to head request > /dev/null
}

test_what_a_scraper_gets_is_as_prometheus_wants_it() {
  need_prometheus
  start_line
  local node
  for node in head arm; do
    metrics $node > "$scratch/$node.txt"
    promtool check metrics < "$scratch/$node.txt" > "$scratch/said" 2>&1 \
      || fail "$node: $(cat "$scratch/said")"
    expect "lint of $node" "$(cat "$scratch/said")" ""
  done
  has_line 'roscell_node_state{node="arm",state="active"} 1' "$scratch/head.txt" \
    || fail "$(cat "$scratch/head.txt")"
  has_line 'roscell_requests_total{type="task_request",outcome="done"} 1' \
    "$scratch/head.txt" || fail "$(grep requests "$scratch/head.txt")"
  has_line 'roscell_session_sent_bytes_total{peer="arm"}' "$scratch/head.txt" \
    || fail "$(grep session "$scratch/head.txt")"
  metrics head application/openmetrics-text > "$scratch/open.txt"
  expect "the last line" "$(tail -n 1 "$scratch/open.txt")" "# EOF"
}

test_a_real_prometheus_scrapes_a_node_over_tcp() {
  need_prometheus
  start_line
  local address port query='roscell_tasks{state="running"}' end
  address=$(get head /v1/cell | jq -r .address)
  port=$((20000 + BASHPID % 10000))
  cat > "$scratch/prometheus.yml" << CONFIG
scrape_configs:
  - job_name: roscell
    scrape_interval: 1s
    authorization: { credentials_file: $scratch/head/token }
    static_configs: [ { targets: [ "$address" ] } ]
CONFIG
  prometheus --config.file="$scratch/prometheus.yml" \
    --storage.tsdb.path="$scratch/tsdb" \
    --web.listen-address="127.0.0.1:$port" 2> "$scratch/prometheus.log" &
  echo $! >> "$scratch/pids"
  # Prometheus tells nobody when it has scraped.
  end=$((SECONDS + deadline_s))
  until promtool query instant "http://127.0.0.1:$port" "$query" 2> /dev/null \
    | has_line '=> 1 @'; do
    ((SECONDS < end)) || fail "$(tail -n 5 "$scratch/prometheus.log")"
    sleep 0.5
  done
}

# memory_of PATH: MiB in use on the member, as the coordinator answers there.
memory_of() {
  get head "$1" | jq '.nodes[] | select(.identity.name == "arm")
                      | .resources.memory_mib.used | floor'
}

test_a_coordinator_asks_its_nodes_what_is_in_use_when_that_is_wanted() {
  local before
  start_node head --coordinator --cell line --interface lo
  start_node arm --join "$(discovery_of head)" --interface lo
  await_joined head arm
  before=$(memory_of /v1/cell)
  coproc holder { exec python3 -c \
    'x = bytearray(b"x") * (1 << 30); print("held", flush=True); input()'; }
  read -r _ <&"${holder[0]}"
  expect "what it has reported" "$(memory_of /v1/cell)" "$before"
  [[ $(memory_of '/v1/cell?resources=now') -gt $((before + 500)) ]] \
    || fail "$before MiB before, $(memory_of '/v1/cell?resources=now') with 1024 more"
  echo >&"${holder[1]}"
}
