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

# give_frames NUMBER: gives them to the skill of task t, and waits until it has
# told of them, which it does in its own time. The metrics are in head.txt.
give_frames() {
  local end=$((SECONDS + deadline_s))
  seq "$1" >> "$scratch/data/t.in"
  until metrics head > "$scratch/head.txt" \
    && has_line "^roscell_instance_frames_total{.*} $1\$" "$scratch/head.txt"; do
    ((SECONDS < end)) || fail "$(grep instance "$scratch/head.txt")"
    sleep 0.5
  done
}

test_the_times_of_a_skill_are_a_histogram_of_all_its_frames() {
  need_prometheus
  local family=roscell_instance_latency_seconds of='{instance_id="t-say-.*",task="t",step="say",node="'
  start_line
  give_frames 7
  has_line "^${family}_count$of.*\"} 7\$" "$scratch/head.txt" \
    && has_line "^${family}_bucket$of.*\",le=\"+Inf\"} 7\$" "$scratch/head.txt" \
    && has_line "^${family}_sum$of.*\"} [0-9]" "$scratch/head.txt" \
    || fail "$(grep latency "$scratch/head.txt")"
  expect "buckets" "$(grep -c "^${family}_bucket" "$scratch/head.txt")" 11
  promtool check metrics < "$scratch/head.txt" > "$scratch/said" 2>&1 \
    || fail "$(cat "$scratch/said")"
}

test_a_real_prometheus_scrapes_a_node_over_tcp() {
  need_prometheus
  start_line
  local address port
  give_frames 5
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
  await_value "$port" 'roscell_tasks{state="running"}' '1'
  # It asks for OpenMetrics, where a whole bound is written with its point.
  await_value "$port" 'roscell_instance_latency_seconds_count
    == on(task) roscell_instance_latency_seconds_bucket{le="1.0"}' '5'
  await_value "$port" 'histogram_quantile(0.95, sum by (le, task, step)
    (roscell_instance_latency_seconds_bucket))' '0\.[0-9]*'
}

# await_value PORT QUERY PATTERN: what that Prometheus answers. It tells nobody
# when it has scraped.
await_value() {
  local end=$((SECONDS + deadline_s))
  until promtool query instant "http://127.0.0.1:$1" "$2" \
    2> "$scratch/query.err" > "$scratch/value" \
    && has_line "=> $3 @" "$scratch/value"; do
    ((SECONDS < end)) || fail "$2: $(cat "$scratch/value" "$scratch/query.err" \
      <(tail -n 5 "$scratch/prometheus.log"))"
    sleep 0.5
  done
}

test_every_picture_for_grafana_has_something_to_show() {
  need_prometheus
  start_line
  give_frames 3
  metrics arm >> "$scratch/head.txt"
  local told query wanted
  told=$(awk '$1 == "#" && $2 == "TYPE" {print $3}' "$scratch/head.txt")
  jq -r '.. | .expr? // empty' docs/examples/grafana/roscell.json \
    > "$scratch/queries"
  [[ -s $scratch/queries ]] || fail "no picture asks anything"
  jq -R '{record: "any:query", expr: gsub("\\$__rate_interval"; "1m")}' \
    "$scratch/queries" | jq -s '{groups: [{name: "all", rules: .}]}' \
    > "$scratch/rules.yml"
  promtool check rules --lint=none "$scratch/rules.yml" > "$scratch/said" 2>&1 \
    || fail "$(cat "$scratch/said")"
  while read -r query; do
    while read -r wanted; do
      wanted=${wanted%_total} wanted=${wanted%_bucket}
      has_line -E "^$wanted(_total)?\$" <<< "$told" \
        || fail "nobody tells $wanted: $query"
    done < <(grep -oE '(roscell|process)_[a-z_]+' <<< "$query")
  done < "$scratch/queries"
}

# memory_of PATH: MiB in use on the member, as the coordinator answers there.
memory_of() {
  get head "$1" | jq '.nodes[] | select(.identity.name == "arm")
                      | .resources.memory_mib.used | floor'
}

# have_available MIB: so much memory is free on the member's host, whatever else
# this machine does.
have_available() {
  sed "s/^MemAvailable: .*/MemAvailable:   $(($1 * 1024)) kB/" /proc/meminfo \
    > "$scratch/meminfo.new"
  cat "$scratch/meminfo.new" > "$scratch/meminfo"
}

test_a_coordinator_asks_its_nodes_what_is_in_use_when_that_is_wanted() {
  [[ $(id -u) -eq 0 ]] || skip "a host with memory of its own needs root"
  local before
  have_available 2048
  start_node head --coordinator --cell line --interface lo
  inside=(unshare --mount sh -c
    "mount --bind $scratch/meminfo /proc/meminfo && exec \"\$@\"" sh)
  start_node arm --join "$(discovery_of head)" --interface lo
  inside=()
  await_joined head arm
  before=$(memory_of /v1/cell)
  have_available 1024
  expect "what it has reported" "$(memory_of /v1/cell)" "$before"
  expect "what it says now" "$(memory_of '/v1/cell?resources=now')" \
    $((before + 1024))
}

# costs NAME: what the nodes of its cell cost, as that node's user is told.
costs() {
  to "$1" status --cost -o json > "$scratch/costs.json" || fail "$1 tells nothing"
}

# has_cost FILTER: whether it holds of what was told last.
has_cost() {
  jq -e "$1" "$scratch/costs.json" > /dev/null \
    || fail "$1: $(cat "$scratch/costs.json")"
}

test_a_cell_tells_what_each_of_its_nodes_costs() {
  local node
  start_node head --coordinator --cell line --interface lo
  start_node arm --join "$(discovery_of head)" --interface lo
  await_joined head arm
  for node in head arm; do
    costs $node
    has_cost '[.nodes[].node] | sort == ["arm", "head"]'
    has_cost 'all(.nodes[]; [.windows[].window] == ["minute", "hour", "day"])'
    has_cost 'all(.nodes[].windows[]; .cpu_s >= 0 and .span_s > 0
                  and .pss_bytes > 1048576)'
    has_cost '.nodes[] | select(.node == "arm") | .windows[0].peers
              | .[0].peer == "head" and .[0].sent_bytes > 0
                and .[0].received_bytes > 0'
    has_cost '.nodes[] | select(.node == "head") | .windows[0].peers
              | .[0].peer == "arm" and .[0].sent_bytes > 0'
  done
  to arm status --cost > "$scratch/table" || fail "no table"
  has_line '^head  *minute .*  arm [0-9.]*/[0-9.]*  *-$' "$scratch/table" \
    || fail "$(cat "$scratch/table")"
  stop_node arm KILL
  await head '.event == "node_lost" and .subject == "arm"' > /dev/null
  costs head
  has_cost '.nodes[] | select(.node == "arm")
            | .windows == [] and .trouble == "node '\''arm'\'' is away"'
  has_cost '.nodes[] | select(.node == "head") | .windows | length == 3'
}
