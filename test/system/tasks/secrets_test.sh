# Secrets of nodes: who is given them, who is not, and until when.

. test/system/scenes/terminal.sh
. test/system/scenes/secrets.sh

# start_alone [OPTION...]: a node whose echo skill writes down the secrets that it
# finds when it starts.
start_alone() {
  use_skills
  write_secrets_down
  start_node head --coordinator --cell line --interface lo --label place=head "$@"
}

# It writes them beside the data, so not where they are looked for.
write_secrets_down() {
  mkdir -p "$scratch/data"
  mv "$skills/echo/bin/echo" "$skills/echo/bin/real"
  cat > "$skills/echo/bin/echo" << SCRIPT
#!/bin/sh
{
  cat "\$ROSCELL_SECRETS/key"
  echo " \$PASSWORD \$(stat -c '%a %U' "\$ROSCELL_SECRETS" "\$ROSCELL_SECRETS/key" | tr '\n' ' ')"
} > "$scratch/data/found"
exec "$skills/echo/bin/real"
SCRIPT
  chmod +x "$skills/echo/bin/echo"
  chmod -R a+rwX "$scratch/data"
}

give_both() {
  printf %s "$key_value" | give "${1:-head}" key
  echo "$pass_value" | give "${1:-head}" pass
}

shim_of() {
  readlink "$scratch/${1:-head}/instances/$instance/pid" | cut -d' ' -f1
}

program_of() {
  readlink "$scratch/${1:-head}/instances/$instance/pid" | cut -d' ' -f3
}

folder_of() {
  tr '\0' '\n' < "/proc/$(program_of "$@")/environ" | sed -n 's/^ROSCELL_SECRETS=//p'
}

# await_state STATE [SINCE]
await_state() {
  await head ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"$1\"" "${2:-0}"
}

last_event() {
  "$ROSCELL" events --to "$scratch/head/node.sock" --no-follow -o json 2> /dev/null \
    | jq -s 'map(.sequence) | max'
}

# restart_program: it is killed, and runs again.
restart_program() {
  local since
  since=$(last_event)
  kill -KILL "$(program_of)"
  await_state running "$since" > /dev/null
}

test_a_step_reads_the_secrets_of_its_node_and_nobody_else_has_them() {
  start_alone
  give_both
  run_with_secrets t
  expect "what it found" "$(cat "$scratch/data/found")" \
    "$key_value $pass_value 700 root 400 root "
  expect "who has them" "$(secrets_of head | jq -c '[.[] | [.name, .instances]]')" \
    "[[\"key\",[\"$instance\"]],[\"pass\",[\"$instance\"]]]"
  expect "the file system" "$(stat -f -c %T "$(folder_of)")" tmpfs
  expect "modes on the disk" "$(stat -c %a "$scratch/head/secrets" \
    "$scratch/head/secrets/key.secret" | tr '\n' ' ')" "700 600 "
  nobody_has_them head
  expect "a command beside it" \
    "$(to head exec -n "$instance" -- sh -c 'cat $ROSCELL_SECRETS/key; echo $PASSWORD')" \
    "$key_value$pass_value"
  nobody_has_them head
  lines_come t line
  local folder
  folder=$(folder_of)
  terminate t
  [[ ! -e $folder ]] || fail "its files are left: $(ls -l "$folder")"
}

test_secrets_belong_to_the_user_that_a_skill_runs_as() {
  chmod 0755 "$scratch"
  start_alone --grant echo=user:nobody
  give_both
  run_with_secrets t
  expect "what it found" "$(cat "$scratch/data/found")" \
    "$key_value $pass_value 700 nobody 400 nobody "
  lines_come t line
}

test_only_a_node_with_the_secrets_of_a_step_is_a_place_for_it() {
  use_skills
  bridge_hosts 3
  make_site_token
  start_on 1 head --coordinator --cell line
  start_on 2 arm --join "$(discovery_of head)"
  start_on 3 belt --join "$(discovery_of head)"
  await_joined head arm
  await_joined head belt
  secret_task t > "$scratch/task.json"
  ! to head request "$scratch/task.json" > "$scratch/reply.json" || fail "it runs"
  expect "its reasons" "$(jq -c '[.error.rejected[].reasons[]] | unique' "$scratch/reply.json")" \
    "$(jq -nc '[("key", "pass") | "needs the secret '"'\\(.)'"', the node does not have it: `roscell secret set \(.)` there"]')"
  give_both arm
  run_with_secrets t
  expect "the node" "$(jq -r '.instances[0].node' "$scratch/reply.json")" arm
  lines_come t line
  # By the address of the node its value would be heard.
  printf %s "$key_value" | ip netns exec "${hosts[0]}" "$ROSCELL" secret set \
    --to 10.231.7.2 key 2> "$scratch/err" && fail "it is sent to another host"
  has_line "on the host of its node only" "$scratch/err" || fail "$(cat "$scratch/err")"
  jq -nc --arg value "$(printf %s "$key_value" | base64 -w0)" \
    '{type: "secret_setting", name: "key", value: $value}' > "$scratch/setting.json"
  ip netns exec "${hosts[0]}" curl -sS -d "@$scratch/setting.json" \
    -H "Authorization: Bearer $(cat "$scratch/arm/token")" \
    "http://10.231.7.2:$(get arm /v1/node | jq -r .identity.address | cut -d: -f2)/v1/requests" \
    > "$scratch/answer"
  expect "by curl" "$(jq -r .error.code "$scratch/answer")" unauthorized
  not_in "the refusal" "$scratch/answer"
  nobody_has_them arm
  # The coordinator has nothing of them.
  ! grep -rqF -e "$key_value" -e "$pass_value" "$scratch/head" || fail "the coordinator has them"
  terminate t
  forget arm key
  ! to head request "$scratch/task.json" > "$scratch/reply.json" || fail "it runs"
}

test_a_changed_secret_comes_with_the_next_start_and_one_that_is_set_again_heals() {
  local since row
  start_alone
  give_both
  run_with_secrets t
  lines_come t first
  printf 'other-key' | give head key
  expect "meanwhile" "$(cat "$(folder_of)/key")" "$key_value"
  restart_program
  expect "after a new start" "$(cut -d' ' -f1 "$scratch/data/found")" other-key
  lines_come t second
  forget head key
  has_line "until they end these have it: $instance" "$scratch/said" || fail "$(cat "$scratch/said")"
  since=$(last_event)
  kill -KILL "$(program_of)"
  row=$(await head ".event == \"instance_changed\" and .subject == \"$instance\"
    and .data.state == \"backing_off\" and (.data.reason | contains(\"secret\"))" "$since")
  expect "its reason" "$(jq -r .data.reason <<< "$row")" \
    "node 'head' has no secret 'key' (\`roscell secret set key\` there)"
  since=$(last_event)
  printf 'third-key' | give head key
  await_state running "$since" > /dev/null
  expect "after it was set" "$(cut -d' ' -f1 "$scratch/data/found")" third-key
  lines_come t third
  expect "all frames" "$(sort -u "$scratch/data/t.out" | wc -l)" 15
}

test_an_update_to_another_secret_changes_that_step() {
  start_alone
  give_both
  printf 'other-key' | give head other
  run_with_secrets t
  jq '.pipeline[0].secret_env.PASSWORD = "other"' "$scratch/t.json" > "$scratch/u.json"
  "$ROSCELL" apply --to "$scratch/head/node.sock" --dry-run "$scratch/u.json" \
    > "$scratch/plan" && fail "nothing differs"
  has_line "secret_env.PASSWORD" "$scratch/plan" || fail "$(cat "$scratch/plan")"
  "$ROSCELL" apply --to "$scratch/head/node.sock" "$scratch/u.json" > "$scratch/plan" 2>&1 \
    || fail "$(cat "$scratch/plan")"
  expect "its variable" "$(cut -d' ' -f2 "$scratch/data/found")" other-key
  lines_come t line
}

test_secrets_survive_the_death_of_their_node() {
  local before folder since stray
  start_alone
  give_both
  run_with_secrets t
  lines_come t first
  before=$(program_of)
  folder=$(folder_of)
  stray=$(dirname "$folder")/t-say-00000000
  mkdir "$stray"
  stop_node head KILL
  [[ -e $folder/key ]] || fail "its files went with the node"
  start_node head --coordinator --cell line --interface lo --label place=head
  await head '.event == "instance_adopted"' > /dev/null
  expect "the program" "$(program_of)" "$before"
  expect "its file" "$(cat "$folder/key")" "$key_value"
  [[ ! -e $stray ]] || fail "what an instance has left that is gone is still there"
  expect "who has it" "$(secrets_of head | jq -r '.[0].instances[0]')" "$instance"
  lines_come t second
  # Its program ends while the node is away: the next one is given them anew.
  since=$(last_event)
  stop_node head KILL
  kill -KILL "$before"
  timeout "$deadline_s" tail --pid="$before" -f /dev/null
  rm "$scratch/data/found"
  start_node head --coordinator --cell line --interface lo --label place=head
  await_state running "$since" > /dev/null
  expect "what the next one found" "$(cut -d' ' -f1,2 "$scratch/data/found")" \
    "$key_value $pass_value"
  lines_come t third
  expect "all frames" "$(sort -u "$scratch/data/t.out" | wc -l)" 15
  folder=$(folder_of)
  terminate t
  [[ ! -e $folder ]] || fail "its files are left"
}

# However far a node is when it is killed, a secret is the old or the new one.
test_a_secret_is_whole_whenever_its_node_is_killed() {
  local n size value
  start_alone
  for n in 1 2 3 4 5; do
    (
      for size in {1..400}; do
        head -c $((1000 + size)) /dev/zero | tr '\0' x | "$ROSCELL" secret set \
          --to "$scratch/head/node.sock" key 2> /dev/null || exit 0
      done
    ) &
    value=$!
    # Until some are written; when it is killed differs from round to round.
    await head '.event == "secret_set"' "$(last_event)" > /dev/null
    timeout 0.0$((n * 17 % 90 + 10)) tail -f /dev/null
    stop_node head KILL
    wait "$value"
    size=$(stat -c %s "$scratch/head/secrets/key.secret")
    [[ $size -gt 1000 && $size -le 1400 ]] || fail "it has $size bytes"
    expect "what it is made of" "$(tr -d x < "$scratch/head/secrets/key.secret" | wc -c)" 0
    start_node head --coordinator --cell line --interface lo --label place=head
    expect "what is there" "$(ls "$scratch/head/secrets")" key.secret
    expect "what is told" "$(secrets_of head | jq -r '.[].name')" key
  done
}

test_what_is_no_secret_is_refused_and_says_why() {
  start_alone
  refused() {
    local code=0
    "$ROSCELL" secret "$@" --to "$scratch/head/node.sock" 2> "$scratch/err" || code=$?
    [[ $code -ne 0 ]] || fail "taken: $*"
  }
  refused set key < /dev/null
  has_line "there is no value" "$scratch/err" || fail "$(cat "$scratch/err")"
  head -c 65537 /dev/zero | refused set key
  has_line "65536" "$scratch/err" || fail "$(cat "$scratch/err")"
  echo x | refused set ../key
  echo x | refused set key value
  refused set key --file "$scratch/none"
  refused remove key
  has_line "node 'head' has no secret 'key'" "$scratch/err" || fail "$(cat "$scratch/err")"
  echo x | give head key --keep-newline
  expect "with its line end" "$(wc -c < "$scratch/head/secrets/key.secret")" 2
  printf 'a\0b' > "$scratch/bytes"
  give head key --file "$scratch/bytes"
  cmp "$scratch/bytes" "$scratch/head/secrets/key.secret" || fail "they differ"
  # A foreign file stops nothing, and is told.
  stop_node head
  echo x > "$scratch/head/secrets/notes"
  start_node head --coordinator --cell line --interface lo --label place=head
  await head '.event == "secret_ignored" and (.data.path | endswith("/notes"))' > /dev/null
  expect "what is left" "$(secrets_of head | jq -r '.[].name')" key
}

test_a_terminal_does_not_show_a_secret() {
  start_alone
  open_terminal 80 24
  run_here "$ROSCELL secret set --to $scratch/head/node.sock key"
  await_screen "^Value of 'key':"
  type_keys "$key_value" Enter
  await_screen '^The same once more:'
  type_keys "$key_value" Enter
  await_screen "secret 'key' is set"
  ended_with 0
  on_screen > "$scratch/screen"
  not_in "the screen" "$scratch/screen"
  expect "the value" "$(cat "$scratch/head/secrets/key.secret")" "$key_value"
  run_here "$ROSCELL secret set --to $scratch/head/node.sock key"
  await_screen "^Value of 'key':"
  type_keys "$key_value" C-c
  ended_with 130
}
