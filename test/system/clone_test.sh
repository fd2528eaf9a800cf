# Hosts that were copied: two with one UUID. All hosts of a test have one
# /etc/machine-id, as copies have.

. test/system/scenes/days_scene.sh

# copy_host OF NAME: a fourth host with a copy of that one's data directory, taken
# while its node runs.
copy_host() {
  cp -a "$scratch/$1" "$scratch/$2"
  cat /proc/sys/kernel/random/uuid > "$scratch/$2.boot"
}

# start_copy NAME [OPTION...]: its node, on a kernel of its own: what runs on the
# other host is not there.
start_copy() {
  inside=(ip netns exec "${hosts[3]}" unshare --pid --fork --kill-child
    --mount-proc bash -c
    'mount --bind "$0" /proc/sys/kernel/random/boot_id && exec "$@"'
    "$scratch/$1.boot")
  start_node "$1" --interface eth0 --site-token "$scratch/site.token" "${@:2}"
  inside=()
}

# refusal_of NAME: why its node does not get into the cell.
refusal_of() {
  await "$1" '.event == "join_refused"' "${2:-0}" | jq -r '"\(.data)"'
}

uuid_of() {
  get "$1" /v1/node | jq -r .identity.uuid
}

epoch_of() {
  get head /v1/cell | jq --arg name "$1" \
    '.nodes[] | select(.identity.name == $name) | .identity.epoch'
}

test_a_copy_of_a_host_is_refused_and_data_of_the_first_one_flow() {
  local before why
  bridge_hosts 4
  start_day
  before=$(epoch_of right)
  copy_host right twin
  start_copy twin --join "$head_at:11811"
  expect "its UUID" "$(uuid_of twin)" "$(uuid_of right)"
  why=$(refusal_of twin)
  [[ $why == *"is in use at 10.231.7.3:8420: its data directory is a copy"* ]] \
    || fail "it says: $why"
  [[ $why == *--new-identity* ]] || fail "no remedy: $why"
  to twin status > "$scratch/status" 2>&1
  has_line -e --new-identity "$scratch/status" || fail "$(cat "$scratch/status")"
  # It goes on trying.
  loses_nobody head "${ROSCELL_COPY_S:-12}"
  expect "the epoch of the first" "$(epoch_of right)" "$before"
  expect "rows" "$(get head /v1/cell | jq '.nodes | length')" 3
  possible=$EPOCHREALTIME
  day_ends 5
  stop_node twin KILL
  start_copy twin --join "$head_at:11811" --new-identity
  await_joined head twin
  [[ $(uuid_of twin) != "$(uuid_of right)" ]] || fail "it has the same UUID"
  possible=$EPOCHREALTIME
  all_flow 5 "beside a copy with an identity of its own"
}

test_of_two_copies_that_come_at_once_one_is_refused() {
  local winner other uuid
  bridge_hosts 4
  start_day
  uuid=$(uuid_of right)
  copy_host right twin
  stop_node head
  stop_node right
  start_copy twin --join "$head_at:11811"
  inside=(ip netns exec "${hosts[2]}")
  start_node right --interface eth0 --label place=right --label spare=yes \
    --site-token "$scratch/site.token" --join "$head_at:11811"
  inside=()
  start_host head
  await head ".event == \"node_joined\" and .data.uuid == \"$uuid\"" \
    > "$scratch/first.json"
  winner=$(jq -r .subject "$scratch/first.json")
  other=twin
  [[ $winner == right ]] || other=right
  why=$(refusal_of "$other")
  [[ $why == *"its data directory is a copy"* ]] || fail "it says: $why"
  stop_node twin KILL
  [[ $winner == right ]] || await_joined head right
  await_member left
  possible=$EPOCHREALTIME
  day_ends 10
}

test_a_copy_of_a_coordinator_does_not_start_beside_it() {
  local domain
  bridge_hosts 4
  start_day
  copy_host head twin
  # On another domain it hears nobody, as on a busy host.
  for domain in "$public_domain" $((public_domain + 1)); do
    (public_domain=$domain start_copy twin --coordinator --cell hall) \
      > "$scratch/said" 2>&1 && fail "it runs beside the first one"
    has_line "10.231.7.1:8420" "$scratch/twin.log" \
      || fail "it says: $(cat "$scratch/twin.log")"
    rm "$scratch/twin.log"
  done
  loses_nobody head 3
  possible=$EPOCHREALTIME
  day_ends 5
}
