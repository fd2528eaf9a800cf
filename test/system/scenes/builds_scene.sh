# What the tests of skills that travel share: cells of nodes that have no skill, and a
# skill that is given to them.

# start_bare NAME...: a cell of nodes without any skill; the first coordinates.
start_bare() {
  local name
  mkdir "$scratch/none"
  for name in "$@"; do
    if [[ $name == "$1" ]]; then
      skills=$scratch/none start_node "$name" --coordinator --cell line \
        --interface lo --label "place=$name"
    else
      skills=$scratch/none start_node "$name" --interface lo \
        --join "$(discovery_of "$1")" --label "place=$name"
      await_joined "$1" "$name"
    fi
  done
}

# skill NODE COMMAND...: a command about skills, spoken to that node.
skill() {
  "$ROSCELL" skill "${@:2}" --to "$scratch/$1/node.sock"
}

# add_echo NODE: the skill of the test becomes one of the cell's.
add_echo() {
  skill "$1" add "$scratch/skills/echo" > "$scratch/added" 2>&1 \
    || fail "not added: $(cat "$scratch/added")"
}

# refused_with CODE NODE COMMAND...: it ends so.
refused_with() {
  local code=$1
  shift
  if skill "$@" -o json > "$scratch/refusal" 2>&1; then
    fail "done all the same: $*"
  fi
  expect "code of $*" "$(jq -r .error.code "$scratch/refusal")" "$code"
}

# start_slow NAME...: a cell of nodes without any skill, each on a host of its own whose
# link takes 30 Mbit/s, and the skill of the test is 12 MiB: three seconds and more.
declare -A host_number=()
start_slow() {
  local name number=0
  bridge_hosts $#
  shape_links 30mbit
  make_site_token
  mkdir "$scratch/none"
  head -c 12MiB /dev/urandom > "$scratch/skills/echo/model"
  for name in "$@"; do
    host_number[$name]=$((++number))
    start_slow_node "$name"
    [[ $name == "$1" ]] || await_joined "$1" "$name"
  done
}

# start_slow_node NAME: the first of them coordinates.
start_slow_node() {
  local options=(--join 10.231.7.1)
  [[ ${host_number[$1]} -ne 1 ]] || options=(--coordinator --cell line)
  discovery_port=11811 skills=$scratch/none start_on "${host_number[$1]}" "$1" \
    --label "place=$1" "${options[@]}"
}

# await_pieces NODE COUNT: so many have come to it.
await_pieces() {
  await "$1" ".event == \"build_fetching\" and .data.pieces >= $2" > /dev/null
}
