# The dashboard in a real browser, against a real cell and under load.

test_people_see_and_do_what_they_came_for() {
  local tool
  for tool in chromium chromedriver; do
    command -v $tool > /dev/null || skip "there is no $tool"
  done
  /usr/bin/python3 -c 'import selenium' 2> /dev/null || skip "there is no Selenium"
  test/dashboard/run.sh "$ROSCELL_BUILD" > "$scratch/said" 2>&1 \
    || fail "$(tail -n 30 "$scratch/said")"
}

# page NAME PATH: what that node's Unix socket shows a browser.
page() {
  curl -sS -i --max-time "$deadline_s" \
    --unix-socket "$scratch/$1/node.sock" "http://node$2"
}

test_a_coordinator_shows_it_to_those_who_may_open_its_socket_only() {
  local address
  start_node head --coordinator --cell line --interface lo
  page head /dashboard/ > "$scratch/said"
  has_line 'Content-Security-Policy: default-src' "$scratch/said" \
    || fail "$(head -n 20 "$scratch/said")"
  address=$(get head /v1/cell | jq -r .address)
  expect "over TCP" "$(curl -s -o /dev/null -w '%{http_code}' \
    -H "Authorization: Bearer $(cat "$scratch/head/token")" \
    "http://$address/dashboard/")" 404
  start_node arm --interface lo --join "$(discovery_of head)"
  page arm /dashboard/ > "$scratch/said"
  has_line '404 Not Found' "$scratch/said" || fail "$(head -n 3 "$scratch/said")"
}
