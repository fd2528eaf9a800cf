# Wall clocks that jump while nodes and their programs run, and some that begin in
# 1970. The clock of this machine is not set: see own_clocks.

. test/system/scenes/days_scene.sh

# own_clocks: each host has a wall clock of its own from now on, programs that
# nodes start and the test's own included. To be called before the day is started.
own_clocks() {
  local name
  for name in "${!number_of[@]}"; do set_clock "$name" 0; done
  set_clock test 0
  export CLOCK_FILE=$scratch/test.clock
  export LD_PRELOAD=$ROSCELL_BUILD/bin/libbent_host.so
  # A sanitizer wants to be the first library.
  export ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0
}

# set_clock NAME SECONDS: the wall clock of a host is so far ahead from now on.
set_clock() {
  local file=$scratch/$1.clock
  # Not cut first: programs have it in their memory.
  printf '%24d' "$2" 1<> "$file"
}

# at NAME COMMAND...: on that host, by its clock.
at() {
  nsenter --target "${pid[$1]}" --mount --net -- "${@:2}"
}

# flows STREAM SECONDS WHEN: instead of the scene's, which goes by what a reader's
# wall clock said when a picture came.
flows() {
  local file=$scratch/data/$1 before
  before=$(wc -l < "$file")
  timeout "$2" grep -m $((before + 3)) frame_id > "$scratch/$1.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$file" 2> /dev/null) \
    || fail "stream '$1': $(($(wc -l < "$file") - before)) pictures in $2 s $3"
  echo "    stream '$1': pictures after $(seconds_since "$possible") s $3"
}

# It goes by such times, too.
tell_gap() { :; }

slow=(test_data_flow_whatever_the_clocks_of_hosts_do)

day_s=86400

# goes_on WHEN: pictures come in time, nobody was lost or has joined again, and
# no program was started again.
goes_on() {
  possible=$EPOCHREALTIME
  all_flow 5 "$1"
  expect "lost or joined $1" "$(get head '/v1/events?since=0&follow=0' \
    | grep -cE '^event: (node_lost|node_joined|coordinator_lost)$')" 2
  expect "started again $1" "$(get head /v1/instances \
    | jq '[.instances[] | select((.restarts // 0) > 0)] | length')" 0
}

# ages_are_right NAME WHEN: what this host's clients make of the times that its node
# tells: nothing is older than the test, and nothing is yet to come. The times of
# files are of a disk that knows one clock only.
ages_are_right() {
  local path wrong at_most=$(((SECONDS + 5) * 1000))
  for path in node cell tasks instances; do
    wrong=$(at "$1" curl -sS --unix-socket "$scratch/$1/node.sock" \
      "http://node/v1/$path" | jq -c --argjson most "$at_most" \
      --argjson now "$(at "$1" date +%s%3N)" '[paths(numbers) as $at
        | select(($at[-1] | tostring
            | endswith("unix_ms") and . != "added_unix_ms") and getpath($at) != 0)
        | {at: ($at | map(tostring) | join("/")), age_ms: ($now - getpath($at))}
        | select(.age_ms < -2000 or .age_ms > $most)]')
    expect "ages in /v1/$path of $1 $2" "$wrong" '[]'
  done
  wrong=$(at "$1" "$ROSCELL" events --to "$scratch/$1/node.sock" --since 0 \
    --no-follow -o json | jq -c --argjson most "$at_most" \
    --argjson now "$(at "$1" date +%s%3N)" '($now - .time_unix_ms) as $age
      | select($age < -2000 or $age > $most) | [.event, $age]' | head -n 1)
  expect "times of events of $1 $2" "$wrong" ''
}

all_ages_are_right() {
  local name
  for name in head left right; do ages_are_right "$name" "$1"; done
}

test_data_flow_whatever_the_clocks_of_hosts_do() {
  local first_day=$((60 - EPOCHSECONDS))
  # Programs of one host speak by shared memory, whose waits end at times of day.
  streams+=(within) camera_on[within]=right reader_on[within]=right
  own_clocks
  set_clock head $first_day
  set_clock left $first_day
  start_day
  set_clock head 0
  set_clock right $day_s
  goes_on "once the coordinator's clock was set from 1970, another's a day ahead"
  all_ages_are_right "then"
  set_clock left 0
  set_clock right 0
  goes_on "once a member's clock was set from 1970, another's a day back"
  all_ages_are_right "after that"
  set_clock head -$day_s
  set_clock right -$day_s
  goes_on "once two clocks were set a day back"
  all_ages_are_right "at last"
  possible=$EPOCHREALTIME
  day_ends 5
  all_ages_are_right "after the day"
}
