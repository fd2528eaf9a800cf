# Container images that come from other nodes of the cell, or from registries of
# one's own. What stands for two hosts are two engines, each with its own data.

variants=(docker podman)
. test/system/scenes/engine.sh

before_all() {
  start_engine
}

after_all() {
  stop_engine
}

# start_second_engine: one that knows no image. It is $engine from here on; the
# first one is $first.
start_second_engine() {
  first=$engine_socket
  use_own_engine
  trap 'stop_engine; clean_up' EXIT
  launch_engine || fail "no second engine: $(tail "$engine_dir/log")"
}

first_engine() {
  docker -H "unix://$first" "$@"
}

# start_head [OPTION...]: the coordinator, with the engine that there is.
start_head() {
  start_node head --coordinator --cell line --interface lo --label place=head "$@"
}

# start_member NAME [OPTION...]: the same of a member.
start_member() {
  start_node "$1" --interface lo --join "$(discovery_of head)" \
    --label "place=$1" "${@:2}"
  await_joined head "$1"
}

# start_pair: the engine of node arm lacks what that of head has.
start_pair() {
  use_engine
  start_head
  start_second_engine
  start_member arm
}

# told NODE EVENT: how often it has been, so far.
told() {
  to "$1" events --since 0 --no-follow -o json | jq -s --arg what "$2" \
    'map(select(.event == $what)) | length'
}

# hear_of_change: nodes that run see the skill as it is now.
hear_of_change() {
  local node
  for node in "${!pid[@]}"; do
    await "$node" ".event == \"skill_added\" and .data.node == \"$node\"" \
      > /dev/null
  done
}

# base_is NAME: what the skill's image is built on.
base_is() {
  local text
  text=$(jq --arg base "$1" '.models[].deployments[].base_image = $base' \
    "$skills/echo/skill.json")
  echo "$text" > "$skills/echo/skill.json"
  hear_of_change
}

id_of() {
  "$1" image inspect --format '{{.Id}}' "$2" | sed 's/^sha256://'
}

# refused_on NODE TASK: its refusal, in refusal.json.
refused_on() {
  echo_task "$2" "$1" > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/refusal.json" \
    && fail "taken: $(cat "$scratch/refusal.json")"
  expect "code" "$(jq -r .error.code "$scratch/refusal.json")" engine_failed
}

says() {
  jq -r '.error.message + " " + .error.hint' "$scratch/refusal.json" \
    | grep -qF -- "$1" || fail "no '$1' in: $(cat "$scratch/refusal.json")"
}

test_a_base_image_comes_from_a_node_whose_engine_has_it() {
  start_pair
  run_on arm hello
  lines_come hello first
  await arm '.event == "image_fetched" and .subject == "debian:bookworm-slim"
    and .data.node == "head"' > /dev/null
  expect "its id" "$(id_of engine debian:bookworm-slim)" \
    "$(id_of first_engine debian:bookworm-slim)"
  expect "pulls" "$(told arm image_not_fetched)" 0
  to head restart hello > "$scratch/restarted" 2>&1 \
    || fail "no restart: $(cat "$scratch/restarted")"
  lines_come hello second
  # Another image of a skill needs nothing more.
  echo changed > "$skills/echo/note"
  hear_of_change
  run_on arm again
  lines_come again first
  expect "images that came" "$(told arm image_fetched)" 1
  left=$(find "$scratch"/*/builds/images -mindepth 1)
  [[ -z $left ]] || fail "something is left: $left"
}

test_of_an_image_only_those_layers_come_that_are_not_there() {
  local bytes
  [[ $variant == docker ]] || skip "Podman's load takes whole images only"
  start_pair
  run_on arm hello
  printf 'FROM debian:bookworm-slim\nRUN echo more > /more\n' \
    | first_engine build --network none -t upper:1 - > "$scratch/built" 2>&1 \
    || fail "$(cat "$scratch/built")"
  base_is upper:1
  run_on arm upper
  lines_come upper first
  bytes=$(await arm '.event == "image_fetched" and .subject == "upper:1"' \
    | jq .data.bytes)
  [[ $bytes -lt 1000000 ]] || fail "$bytes bytes came"
  expect "its id" "$(id_of engine upper:1)" "$(id_of first_engine upper:1)"
}

test_a_node_that_dies_while_it_gives_an_image_is_replaced_by_another_one() {
  local giver
  use_engine
  runtime=process start_head
  start_member left
  start_member right
  start_second_engine
  start_member arm
  echo_task hello arm > "$scratch/task.json"
  to head request "$scratch/task.json" > "$scratch/reply.json" &
  request=$!
  await left '.event == "image_shared"' > /dev/null
  kill -KILL "${pid[left]}"
  wait "$request" || fail "refused: $(cat "$scratch/reply.json")"
  lines_come hello first
  giver=$(await arm '.event == "image_fetched"' | jq -r .data.node)
  [[ $giver == left || $giver == right ]] || fail "it came from $giver"
}

# start_registry: one that knows its users, at $registry, with a base image of
# ours. Who has logged in there is in $scratch/logged_in.
start_registry() {
  local port=$((20000 + BASHPID % 20000))
  command -v docker-registry > /dev/null || skip "docker-registry is missing"
  command -v htpasswd > /dev/null || skip "htpasswd is missing"
  registry=127.0.0.1:$port
  htpasswd -Bbn robot secret-word > "$scratch/users"
  cat > "$scratch/registry.yml" << CONF
version: 0.1
storage: {filesystem: {rootdirectory: $scratch/registry}}
http: {addr: "$registry"}
auth: {htpasswd: {realm: trial, path: $scratch/users}}
CONF
  docker-registry serve "$scratch/registry.yml" > "$scratch/registry.log" 2>&1 &
  registry_process=$!
  echo "$registry_process" >> "$scratch/pids"
  grep -m 1 -q 'listening on' < <(exec timeout "$deadline_s" tail -n +1 \
    --pid="$registry_process" -f "$scratch/registry.log") \
    || fail "no registry: $(cat "$scratch/registry.log")"
  mkdir "$scratch/logged_in"
  jq -n --arg registry "$registry" --arg auth "$(printf robot:secret-word \
    | base64)" '{auths: {($registry): {auth: $auth}}}' \
    > "$scratch/logged_in/config.json"
  chmod 600 "$scratch/logged_in/config.json"
}

# A Podman of the test's own asks registries of this host without TLS.
allow_plain_registries() {
  export CONTAINERS_REGISTRIES_CONF=$scratch/registries.conf
  printf '[[registry]]\nlocation = "127.0.0.1"\ninsecure = true\n' \
    > "$CONTAINERS_REGISTRIES_CONF"
  [[ -z ${registry:-} ]] \
    || printf '[[registry]]\nlocation = "%s"\ninsecure = true\n' "$registry" \
      >> "$CONTAINERS_REGISTRIES_CONF"
}

# fill_registry: an engine of the test's own gives it the image, and pulls it.
fill_registry() {
  use_engine
  start_registry
  allow_plain_registries
  start_second_engine
  engine import "$base_tar" "$registry/base:1" > /dev/null
  DOCKER_CONFIG=$scratch/logged_in engine push "$registry/base:1" \
    > "$scratch/pushed" 2>&1 || fail "$(cat "$scratch/pushed")"
  engine rmi "$registry/base:1" > /dev/null
  base_is "$registry/base:1"
}

test_a_private_registry_is_asked_as_the_user_who_has_logged_in_there() {
  fill_registry
  mkdir "$scratch/logged_out"
  DOCKER_CONFIG=$scratch/logged_out start_head
  refused_on head hello
  says "registry '$registry' does not let this node have '$registry/base:1'"
  says "$engine_name login $registry"
  stop_node head
  DOCKER_CONFIG=$scratch/logged_in start_head
  run_on head hello
  lines_come hello first
  await head ".event == \"image_pulled\" and .data.registry == \"$registry\"" \
    > /dev/null
  ! grep -rq "secret-word\|$(printf robot:secret-word | base64)" \
    "$scratch/head" "$scratch/head.log" || fail "the node has told a secret"
}

test_a_node_may_have_logins_of_its_own_that_others_may_not_read() {
  fill_registry
  export DOCKER_CONFIG=$scratch/logged_out
  mkdir "$DOCKER_CONFIG"
  cp "$scratch/logged_in/config.json" "$scratch/own.json"
  chmod 644 "$scratch/own.json"
  start_head --registry-auth "$scratch/own.json"
  refused_on head hello
  says "chmod 600 $scratch/own.json"
  chmod 600 "$scratch/own.json"
  run_on head hello
  lines_come hello first
}

test_a_wrong_password_is_told_with_the_registry() {
  fill_registry
  printf robot:wrong | base64 > "$scratch/wrong"
  jq --arg auth "$(cat "$scratch/wrong")" '.auths[].auth = $auth' \
    "$scratch/logged_in/config.json" > "$scratch/text"
  cat "$scratch/text" > "$scratch/logged_in/config.json"
  DOCKER_CONFIG=$scratch/logged_in start_head
  refused_on head hello
  says "registry '$registry' does not let this node have"
  ! grep -q wrong "$scratch/refusal.json" || fail "it tells the password"
}

test_an_image_that_is_pinned_by_a_digest_travels_by_its_id() {
  local digest
  fill_registry
  digest=$(curl -sS -u robot:secret-word -o "$scratch/body" -D - \
    -H 'Accept: application/vnd.docker.distribution.manifest.v2+json' \
    -H 'Accept: application/vnd.oci.image.manifest.v1+json' \
    "http://$registry/v2/base/manifests/1" \
    | tr -d '\r' | sed -n 's/^Docker-Content-Digest: //Ip')
  base_is "$registry/base@$digest"
  DOCKER_CONFIG=$scratch/logged_in start_head
  run_on head here
  lines_come here first
  # Nobody can be asked any more but the other node.
  kill "$registry_process"
  runtime=$engine_name:$first
  start_member arm
  run_on arm there
  lines_come there first
  await arm '.event == "image_fetched" and .data.node == "head"' > /dev/null
  to head restart there > "$scratch/restarted" 2>&1 \
    || fail "no restart: $(cat "$scratch/restarted")"
  lines_come there second
  first_engine rmi -f "roscell-pinned:${digest:7:32}" > /dev/null
}

# start_odd_registry ANSWER: a server on $registry that is none.
start_odd_registry() {
  local said port
  exec {said}< <(exec python3 - "$1" << 'SERVER'
import http.server, sys, threading

class odd(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        if sys.argv[1] == 'nothing':
            threading.Event().wait()
        status = {'401': 401, '429': 429, 'garbage': 200}[sys.argv[1]]
        body = b'\0garbage<' * 9 if status == 200 else b'{"errors": [{"code": \
"TOOMANYREQUESTS", "message": "slow down"}]}' if status == 429 else b'{}'
        self.send_response(status)
        if status == 401:
            self.send_header('Www-Authenticate', 'Basic realm="odd"')
        self.send_header('Content-Length', str(len(body)))
        self.end_headers()
        self.wfile.write(body)
    do_HEAD = do_GET
    def log_message(self, *x):
        pass

server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), odd)
print(server.server_address[1], flush=True)
server.serve_forever()
SERVER
)
  echo $! >> "$scratch/pids"
  read -r port <&"$said"
  registry=127.0.0.1:$port
  base_is "$registry/base:1"
}

# odd_registry ANSWER TEXT...: what is told of one that answers so.
odd_registry() {
  local text
  start_odd_registry "$1"
  [[ $variant == docker ]] || skip "a Podman of all asks no plain registries"
  [[ -n ${pid[head]:-} ]] || start_head
  refused_on head "$1"
  says "registry '$registry'"
  for text in "${@:2}"; do
    says "$text"
  done
}

test_a_registry_that_lets_nobody_in_is_named_with_a_remedy() {
  use_engine
  odd_registry 401 "docker login 127.0.0.1:"
}

test_a_registry_that_was_asked_too_often_is_named_with_a_remedy() {
  use_engine
  odd_registry 429 "asked too often" "wait"
}

test_a_registry_that_is_none_is_named_with_a_remedy() {
  use_engine
  odd_registry garbage "is it a registry?"
}

test_a_registry_that_says_nothing_is_named_with_a_remedy() {
  use_engine
  deadline_s=120
  odd_registry nothing "docker pull 127.0.0.1:"
}

test_images_of_skills_that_nobody_has_are_removed_beyond_the_bound() {
  use_engine
  start_head --skill-images 0
  run_on head first
  image=$(engine ps --format '{{.Image}}')
  jq -n '{type: "task_termination", task: "first"}' | to head request \
    > "$scratch/end.json" || fail "$(cat "$scratch/end.json")"
  engine image inspect "$image" > /dev/null || fail "it is gone too soon"
  echo changed > "$skills/echo/note"
  hear_of_change
  run_on head second
  await head ".event == \"image_removed\" and .subject == \"$image\"" > /dev/null
  lines_come second word
  engine image inspect "$(engine ps --format '{{.Image}}')" > /dev/null \
    || fail "that of a container is gone"
}
