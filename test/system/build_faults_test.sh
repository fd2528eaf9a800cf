# Skills on their way to a node, and what goes wrong meanwhile. Each test has lines come
# out at the far end after the repair, and again after the next step.

. test/system/scenes/builds_scene.sh

# begin_on NODE TASK: as run_on, but it is not waited for.
begin_on() {
  echo_task "$2" "$1" > "$scratch/$2.json"
  to head request "$scratch/$2.json" > "$scratch/$2.reply" 2>&1 &
  begun=$!
}

# went_on NODE COUNT: so many pieces did not come once more.
went_on() {
  local given all
  given=$(await "$1" '.event == "build_fetched"' | jq '[.data.pieces[]] | add')
  all=$(await "$1" '.event == "build_fetching"' | jq .data.of)
  [[ $given -le $((all - $2)) ]] || fail "$given of $all pieces came"
}

runs_now() {
  wait "$begun" || fail "refused: $(cat "$scratch/$1.reply")"
  lines_come "$1" first
  to head restart "$1" > "$scratch/restarted" 2>&1 \
    || fail "no restart: $(cat "$scratch/restarted")"
  lines_come "$1" second
}

# add_to NODE...: the skill becomes one of the cell's; of these nodes $second keeps it,
# too, and $other does not.
add_to() {
  add_echo head
  second=$(get head /v1/skills | jq -r '.builds[0].keepers[1]')
  other=$1
  [[ $second != "$1" ]] || other=$2
}

test_a_source_that_dies_in_the_middle_is_named_and_the_other_one_gives_the_rest() {
  start_slow head leg arm
  add_to leg arm
  begin_on "$other" hello
  await_pieces "$other" 1
  expect "on its way" \
    "$(get head /v1/skills | jq -r '.builds[0].coming_to[]')" "$other"
  refused_with conflict head remove echo
  stop_node "$second" KILL
  runs_now hello
  await "$other" ".event == \"build_source_lost\" and .data.source == \"$second\"" \
    > /dev/null
  start_slow_node "$second"
  run_on "$second" later
  lines_come later first
}

test_a_source_whose_disk_gives_other_bytes_is_named_and_the_other_one_asked() {
  start_slow head leg arm
  add_to leg arm
  dd if=/dev/zero of="$(echo "$scratch/$second"/builds/kept/*/model)" bs=1M count=12 \
    conv=notrunc status=none
  begin_on "$other" hello
  runs_now hello
  await "$other" ".event == \"build_source_lost\" and .data.source == \"$second\"" \
    > /dev/null
}

test_a_node_that_is_killed_while_it_fetches_goes_on_with_what_has_come() {
  start_slow head arm leg
  add_to arm leg
  begin_on "$other" hello
  await_pieces "$other" 4
  stop_node "$other" KILL
  wait "$begun"
  start_slow_node "$other"
  await_joined head "$other"
  begin_on "$other" again
  runs_now again
  went_on "$other" 4
}

test_a_coordinator_that_is_killed_while_a_skill_is_added_takes_it_the_next_time() {
  local adding
  start_slow head arm
  skill arm add "$scratch/skills/echo" > "$scratch/first" 2>&1 &
  adding=$!
  await_pieces head 4
  stop_node head KILL
  if wait "$adding"; then
    fail "added all the same: $(cat "$scratch/first")"
  fi
  start_slow_node head
  await_joined head arm
  expect "builds" "$(get head /v1/skills | jq '.builds | length')" 0
  add_echo arm
  went_on head 4
  begin_on head hello
  runs_now hello
  stop_node head KILL
  start_slow_node head
  await_joined head arm
  run_on arm later
  lines_come later first
}

test_another_node_holds_the_second_copy_where_the_first_choice_is_killed() {
  local adding chosen name
  start_slow head arm leg
  mkfifo "$scratch/chosen"
  exec {chosen}<> "$scratch/chosen"
  for name in arm leg; do
    { await_pieces "$name" 1 && echo "$name" >&"$chosen"; } &
  done
  skill head add "$scratch/skills/echo" > "$scratch/added" 2>&1 &
  adding=$!
  read -r -t "$deadline_s" second <&"$chosen" || fail "nobody fetches it"
  other=arm
  [[ $second != arm ]] || other=leg
  stop_node "$second" KILL
  wait "$adding" || fail "not added: $(cat "$scratch/added")"
  expect "keepers" \
    "$(get head /v1/skills | jq -r '.builds[0].keepers[]' | xargs)" "head $other"
  begin_on "$other" hello
  runs_now hello
  start_slow_node "$second"
  run_on "$second" later
  lines_come later first
}

test_a_disk_that_is_full_is_named_and_the_node_fetches_once_there_is_room() {
  [[ $(id -u) -eq 0 ]] || skip "a file system of its own needs root"
  mkdir "$scratch/arm"
  mount -t tmpfs -o size=10m,mode=0700 none "$scratch/arm" 2> /dev/null \
    || skip "a file system cannot be mounted here"
  trap 'clean_up; umount -l "$scratch/arm"' EXIT
  start_slow head arm leg
  add_echo head
  begin_on arm hello
  if wait "$begun"; then
    fail "it runs: $(cat "$scratch/hello.reply")"
  fi
  grep -q "No space left on device" "$scratch/hello.reply" \
    || fail "said: $(cat "$scratch/hello.reply")"
  grep -q "$scratch/arm/builds" "$scratch/hello.reply" \
    || fail "the place is not named: $(cat "$scratch/hello.reply")"
  mount -o remount,size=64m "$scratch/arm"
  begin_on arm again
  runs_now again
}
