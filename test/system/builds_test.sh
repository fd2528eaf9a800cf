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
