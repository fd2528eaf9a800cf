# What is measured of a day (days_scene.sh): pictures at the readers of all streams.
# To be sourced by what has such a cell.

# day_begins WHAT: from here on it is this day.
day_begins() {
  local name
  day=$1
  for name in "${streams[@]}"; do
    wc -l < "$scratch/data/$name" > "$scratch/$name.before"
  done
}

# note STREAM FIGURES: for people who compare days.
note() {
  local name=$day
  [[ $variant == - ]] || name+=" ($variant)"
  jq -nc --arg day "$name" --arg stream "$1" \
    --argjson figures "$2" '{$day, $stream} + $figures' \
    >> "${ROSCELL_DAYS_FILE:-$kept/days.jsonl}"
}

# arrivals: of pictures that are read from lines, when each was made and when it was
# worked on.
arrivals() {
  jq -ncR '[inputs | fromjson? | {stamp, at: (.stamp + .age_ms / 1000)}]
    | sort_by(.at)'
}

# possible_for STREAM: the moment from which pictures of it can come: they need the
# program that its person has started, too.
possible_for() {
  local since=0
  [[ $1 != guest ]] || since=$(< "$scratch/guest.since")
  jq -n "[$possible, $since] | max"
}

# The times between numbers in a row.
steps='def steps: [.[1:], .[:-1]] | transpose | map(.[0] - .[1]);'

# flows STREAM SECONDS WHEN: from what has made it possible on there is never no picture
# for longer than this, and three more come. By the clock of who has worked on them: a
# busy machine may have no time for this shell.
possible=$EPOCHREALTIME
flows() {
  local file=$scratch/data/$1 before since first longest
  before=$(wc -l < "$file")
  timeout $(($2 + 15)) grep -m $((before + 3)) frame_id > "$scratch/$1.matches" \
    < <(exec tail --pid=$$ -n +1 -F "$file" 2> /dev/null) \
    || fail "stream '$1': $(($(wc -l < "$file") - before)) pictures $3;" \
      "$(to head topics 2>&1 | grep "/$1/")"
  since=$(possible_for "$1")
  read -r first longest < <(arrivals < "$file" \
    | jq -r "$steps [$since, (.[].at | select(. >= $since))] | steps
        | [.[0], max] | map(. * 100 | round / 100) | \"\(.[0]) \(.[1])\"")
  echo "    stream '$1': the first picture after $first s $3"
  note "$1" "$(jq -nc --arg when "$3" --argjson s "$first" '{$when, $s}')"
  jq -en "$longest <= $2" > /dev/null \
    || fail "stream '$1': no picture for $longest s $3"
}

# all_flow SECONDS WHEN
all_flow() {
  local name waits=()
  for name in "${streams[@]}"; do
    flows "$name" "$@" &
    waits+=($!)
  done
  for name in "${waits[@]}"; do
    wait "$name" || exit 1
  done
}

# tell_gap STREAM: the longest time between two pictures since the day began, and how
# many of two a second are missing.
tell_gap() {
  local figures
  figures=$(tail -n +"$(< "$scratch/$1.before")" "$scratch/data/$1" \
    | arrivals | jq -c "$steps"'
      {when: "over the day",
       gap_s: (map(.at) | steps | max // 0 | . * 100 | round / 100),
       missing: (map(.stamp) | sort | steps
         | map([(. * 2 | round) - 1, 0] | max) | add // 0)}')
  echo "    stream '$1': no picture for $(jq .gap_s <<< "$figures") s," \
    "$(jq .missing <<< "$figures") are missing"
  note "$1" "$figures"
}

# day_ends SECONDS: pictures come within this time, only ends that live are named
# as such, and that is so again after each step was started anew.
day_ends() {
  local name step
  all_flow "$1" "after the day"
  names_living_ends_only
  for name in "${streams[@]}"; do tell_gap "$name"; done
  for name in "${streams[@]}"; do
    for step in camera reader; do
      to head restart "$(instance "$name" "$step")" > "$scratch/restart" 2>&1 \
        || fail "not restarted: $(cat "$scratch/restart")"
    done
  done
  possible=$EPOCHREALTIME
  all_flow 10 "after each step was started anew"
  names_living_ends_only
  for name in "${streams[@]}"; do none_is_doubled "$name"; done
}

# Each topic has one writer and one reader, which run, within the time that it
# takes to notice who does not: a discovery server that has lived through the day
# knows a program that was killed for its lease of 30 s.
ends_within_s=$(of_matrix 15 35)
names_living_ends_only() {
  local until=$((SECONDS + ends_within_s)) ends
  while :; do
    ends=$(to head topics -o json 2>&1 | jq -c '[.[]
      | select((.writers | length) != 1 or (.readers | length) != 1)]')
    [[ $ends != '[]' ]] || return 0
    [[ $SECONDS -lt $until ]] || fail "ends that do not live: $ends"
    await_change
  done
}

none_is_doubled() {
  local stamps=$scratch/$1.stamps
  jq -R 'fromjson? | .stamp' "$scratch/data/$1" | sort | uniq -d > "$stamps"
  [[ ! -s $stamps ]] || fail "stream '$1': twice: $(head -n 3 "$stamps")"
}
