# Skills that were added to a cell and come to the nodes that need them.

. test/system/scenes/builds_scene.sh

test_a_skill_that_was_added_once_runs_on_each_node_that_needs_it() {
  local hash node
  start_bare head arm leg
  add_echo arm
  hash=$(get head /v1/skills | jq -r '.builds[0].build.hash')
  expect "keepers" \
    "$(get head /v1/skills | jq -c '.builds[0].keepers | sort')" '["arm","head"]'
  grep -q "${hash:0:12}, is one of the cell's; kept on 'head', 'arm'" \
    "$scratch/added" || fail "said: $(cat "$scratch/added")"
  for node in leg arm head; do
    run_on "$node" "on-$node"
    lines_come "on-$node" first
  done
  await leg ".event == \"build_fetched\" and .subject == \"$hash\"" > /dev/null
  to head restart on-leg > "$scratch/restarted" 2>&1 \
    || fail "no restart: $(cat "$scratch/restarted")"
  lines_come on-leg again
  # A node that starts again has it still.
  stop_node leg
  skills=$scratch/none start_node leg --interface lo \
    --join "$(discovery_of head)" --label place=leg
  lines_come on-leg later
  # The same again changes nothing.
  add_echo leg
  expect "builds" "$(get head /v1/skills | jq '.builds | length')" 1
}

test_a_skill_that_runs_is_not_removed_and_one_that_is_removed_comes_nowhere() {
  start_bare head arm
  add_echo head
  run_on arm hello
  lines_come hello first
  refused_with conflict head remove echo
  lines_come hello second
  to head stop hello > "$scratch/stopped" 2>&1 || fail "$(cat "$scratch/stopped")"
  skill head remove echo > "$scratch/removed" 2>&1 \
    || fail "not removed: $(cat "$scratch/removed")"
  expect "builds" "$(get head /v1/skills | jq '.builds | length')" 0
  refused_with unknown_operation head remove echo
  await head '.event == "skill_removed" and .data.node == "arm"' > /dev/null
  expect "files on arm" "$(find "$scratch/arm/builds" -type f)" ""
}

test_a_node_that_was_away_lets_go_what_was_removed_meanwhile() {
  start_bare head arm
  add_echo head
  run_on arm hello
  lines_come hello first
  to head stop hello > "$scratch/stopped" 2>&1 || fail "$(cat "$scratch/stopped")"
  stop_node arm KILL
  await head '.event == "node_lost" and .subject == "arm"' > /dev/null
  skill head remove echo > "$scratch/removed" 2>&1 \
    || fail "not removed: $(cat "$scratch/removed")"
  skills=$scratch/none start_node arm --interface lo \
    --join "$(discovery_of head)" --label place=arm
  await head '.event == "skill_removed" and .data.node == "arm"' > /dev/null
  echo_task again arm > "$scratch/task.json"
  if to head request "$scratch/task.json" > "$scratch/reply.json" 2>&1; then
    fail "what was removed runs: $(cat "$scratch/reply.json")"
  fi
  add_echo head
  run_on arm later
  lines_come later first
}

test_a_skill_is_pulled_into_a_folder_by_a_node_that_lacked_it() {
  start_bare head arm leg
  add_echo head
  (cd "$scratch" && skill arm pull echo --into copy) > "$scratch/pulled" 2>&1 \
    || fail "not pulled: $(cat "$scratch/pulled")"
  diff -r "$scratch/skills/echo" "$scratch/copy" || fail "it is another one"
  if (cd "$scratch" && skill leg pull echo --into copy) > "$scratch/pulled" 2>&1
  then
    fail "it was written over"
  fi
  grep -q "is there already" "$scratch/pulled" || fail "$(cat "$scratch/pulled")"
}

test_another_build_of_a_version_is_refused_and_changes_nothing() {
  local hash
  start_bare head arm
  jq '.version = "1.0"' "$scratch/skills/echo/skill.json" > "$scratch/text"
  cp "$scratch/text" "$scratch/skills/echo/skill.json"
  add_echo head
  hash=$(get head /v1/skills | jq -r '.builds[0].build.hash')
  touch "$scratch/skills/echo/more"
  refused_with conflict head add "$scratch/skills/echo"
  expect "the build" "$(get head /v1/skills | jq -r '.builds[].build.hash')" "$hash"
  run_on arm hello
  lines_come hello first
}

test_nobody_gets_a_build_without_a_permit_for_it() {
  local hash address reply
  start_bare head arm
  add_echo head
  hash=$(get head /v1/skills | jq -r '.builds[0].build.hash')
  for address in $(get head /v1/cell | jq -r '.nodes[].identity.address'); do
    for reply in "" "Bearer $(printf '0%.0s' {1..64})" "Bearer "; do
      expect "status of $address" \
        "$(curl -sS -o "$scratch/body" -w '%{http_code}' --max-time 10 \
          -H "Authorization: $reply" "http://$address/v1/builds/$hash/pieces/0")" 401
    done
  done
}

test_a_folder_that_is_no_skill_is_not_added() {
  start_bare head
  mkdir "$scratch/odd"
  echo '{"operation": "odd"}' > "$scratch/odd/skill.json"
  refused_with schema_violation head add "$scratch/odd"
  ln -s /etc "$scratch/odd/out"
  if skill head add "$scratch/odd" > "$scratch/said" 2>&1; then
    fail "a link that leads out was taken"
  fi
  grep -q "leads out of the folder" "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "builds" "$(get head /v1/skills | jq '.builds | length')" 0
}

test_an_archive_of_a_skill_is_added_and_one_that_writes_elsewhere_is_not() {
  start_bare head arm
  tar -C "$scratch/skills" -czf "$scratch/echo.tar.gz" echo
  skill head add "$scratch/echo.tar.gz" > "$scratch/added" 2>&1 \
    || fail "not added: $(cat "$scratch/added")"
  run_on arm hello
  lines_come hello first
  mkdir "$scratch/inner"
  echo x > "$scratch/outside"
  tar -C "$scratch/inner" -cPf "$scratch/bad.tar" ../outside
  if skill head add "$scratch/bad.tar" > "$scratch/said" 2>&1; then
    fail "an archive with .. was taken"
  fi
  grep -q "leads out of its folder" "$scratch/said" || fail "$(cat "$scratch/said")"
  expect "builds" "$(get head /v1/skills | jq '.builds | length')" 1
  lines_come hello second
}

# What goes wrong while a build is on its way. Each test has lines come out at the far
# end after the repair, and again after the next step.

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

test_a_source_that_stalls_holds_up_a_fetch_for_seconds_only() {
  local begin
  start_slow head leg arm
  add_to leg arm
  begin_on "$other" hello
  await_pieces "$other" 1
  begin=$SECONDS
  ip link set "$(host_link "${host_number[$second]}")" down
  runs_now hello
  ((SECONDS - begin < 20)) || fail "it took $((SECONDS - begin)) s"
  await head ".event == \"node_lost\" and .subject == \"$second\"" > "$scratch/lost"
  ip link set "$(host_link "${host_number[$second]}")" up
  await_joined head "$second" "$(jq .sequence "$scratch/lost")"
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
