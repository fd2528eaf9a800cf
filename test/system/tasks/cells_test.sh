# A cell as a document: written down, compared, and made anew on other hosts.

# start_line FOLDER NODES...: a cell "line" whose skills come with it, not with its
# hosts, on hosts of their own from the number in $first on.
start_line() {
  local name n=$first
  mkdir -p "$scratch/none"
  skills=$scratch/none
  discovery_port=11811
  start_on "$n" "$1" --coordinator --cell line --cpu-floor 1
  for name in "${@:2}"; do
    start_on $((++n)) "$name" --join "$(discovery_of "$1")" --cpu-floor 1
    await_joined "$1" "$name"
  done
}

# on_cell NODE COMMAND...: what `roscell cell` does, asked of that node.
on_cell() {
  "$ROSCELL" cell "$2" --to "$scratch/$1/node.sock" "${@:3}"
}

# say_task: follows a file on the node arm.
say_task() {
  mkdir -p "$scratch/data"
  touch "$scratch/data/say.in"
  cat << EOF
task: say
labels: {line: "3"}
pipeline:
  - {id: say, operation: echo, model: plain, labels: {node: arm},
     input: $scratch/data/say.in, output: $scratch/data/say.out}
EOF
}

test_a_cell_that_is_exported_is_made_anew_on_other_hosts() {
  bridge_hosts 4
  make_site_token
  first=1
  start_line head arm
  "$ROSCELL" skill add "$scratch/skills/echo" --to "$scratch/head/node.sock" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  say_task > "$scratch/say.yaml"
  to head apply "$scratch/say.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  lines_come say before
  mkdir "$scratch/backup"
  on_cell head export "$scratch/backup/line.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  expect "nodes" "$(jq -c .nodes "$scratch/backup/line.json")" '["arm"]'
  expect "tasks" "$(jq -c '[.tasks[].task]' "$scratch/backup/line.json")" '["say"]'
  [[ -f $scratch/backup/line.skills/echo-$(jq -r '.skills[0].build[:12]' \
    "$scratch/backup/line.json")/skill.json ]] || fail "the build is not there"
  on_cell head diff "$scratch/backup/line.json" > "$scratch/out" 2>&1
  expect "exit code where nothing differs" $? 0
  # Both hosts burn down. Two others take their place.
  stop_node arm KILL
  stop_node head KILL
  pkill -KILL -f "$scratch/(head|arm)/" || true
  first=3
  skills=$scratch/none
  start_on 3 chief --coordinator --cell line --cpu-floor 1
  mv "$scratch/arm" "$scratch/burnt"
  start_on 4 arm --wait --cpu-floor 1
  await chief '.event == "node_appeared" and .subject == "arm"' > /dev/null
  on_cell chief diff "$scratch/backup/line.json" > "$scratch/out" 2>&1
  expect "exit code where all differs" $? 1
  has_line 'node *arm *joins' < "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line 'skill *echo .* is added' < "$scratch/out" || fail "$(cat "$scratch/out")"
  has_line 'task *say *starts' < "$scratch/out" || fail "$(cat "$scratch/out")"
  on_cell chief apply "$scratch/backup/line.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  lines_come say after
  on_cell chief diff "$scratch/backup/line.json" > "$scratch/out" 2>&1
  expect "exit code afterwards" $? 0
  # The next change of it is found and made.
  jq '.tasks[0].pipeline[0].parameters = {prefix: "> "}' "$scratch/backup/line.json" \
    > "$scratch/backup/changed.json"
  sed -i 's/changed.skills/line.skills/' "$scratch/backup/changed.json"
  on_cell chief apply "$scratch/backup/changed.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  lines_come say changed "> "
}

test_a_document_that_does_not_fit_the_cell_changes_nothing() {
  start_node head --coordinator --cell line --interface lo --cpu-floor 1
  say_task > "$scratch/say.yaml"
  sed -i 's/, labels: {node: arm}//' "$scratch/say.yaml"
  to head apply "$scratch/say.yaml" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  on_cell head export - > "$scratch/line.json" 2> "$scratch/out" || fail "$(cat "$scratch/out")"
  # mistake JQ TEXT
  mistake() {
    jq "$1" "$scratch/line.json" > "$scratch/wrong.json"
    on_cell head diff "$scratch/wrong.json" > "$scratch/out" 2>&1
    expect "exit code of diff: $2" $? 2
    has_line "$2" < "$scratch/out" || fail "$2: $(cat "$scratch/out")"
    on_cell head apply "$scratch/wrong.json" > "$scratch/out" 2>&1
    expect "exit code of apply: $2" $? 1
  }
  mistake '.cell = "lab"' "the document is of cell 'lab', and this is cell 'line'"
  mistake '.nodes = ["nobody"]' "'nobody' is no member"
  mistake '.nodes = ["a", "a"]' 'not in the list already'
  mistake '.skills = [{operation: "fly", build: ("0" * 64)}]' "there is no source of it"
  mistake '.tasks[0].pipeline[0].operation = "sing"' "no skill of this cell does 'sing'"
  mistake '.tasks[0].pipeline[0].modle = 1' 'there is no member "modle"'
  expect "tasks" "$(get head /v1/tasks | jq -r '.tasks[0] | "\(.task) \(.revision // 1)"')" "say 1"
  lines_come say still
  # What the cell has besides goes where that is asked for.
  jq '.tasks = []' "$scratch/line.json" > "$scratch/none.json"
  on_cell head apply "$scratch/none.json" > "$scratch/out" 2>&1 || fail "$(cat "$scratch/out")"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 1
  on_cell head apply --prune "$scratch/none.json" > "$scratch/out" 2>&1 \
    || fail "$(cat "$scratch/out")"
  expect "tasks" "$(get head /v1/tasks | jq '.tasks | length')" 0
}
