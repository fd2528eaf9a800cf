# The container engine of the tests: tools/own_engine.sh, once for a file of
# tests. $variant says which: docker, podman, or rootless.

engine_kind=$variant
engine_dir=$suite/engine
base_tar=$ROSCELL_BUILD/../base-images/bookworm.tar
. tools/own_engine.sh

# What the node calls the engine.
engine_name=docker
[[ $variant == docker ]] || engine_name=podman

# The network is there before the tests only.
fetch_all() {
  make_base_tar
}

# For a test: skips it if there is no engine, and uses it if there is one.
use_engine() {
  [[ -f $engine_dir.reason ]] && skip "$(cat "$engine_dir.reason")"
  engine image inspect debian:bookworm-slim > /dev/null 2>&1 \
    || fail "$(cat "$suite/before_all.output")"
  # What a failed test has left.
  engine ps -aq | xargs -r docker -H "unix://$engine_socket" rm -f > /dev/null
  runtime=$engine_name:$engine_socket
  allow_much_memory "$skills/echo"
  [[ $variant != rootless ]] || become_rootless_user
}

# The sanitizers' own memory is many times that of a skill.
allow_much_memory() {
  local text
  text=$(jq '.models[].deployments[].resources.memory_mib = 1024' \
    "$1/skill.json")
  echo "$text" > "$1/skill.json"
}

# The node is the unprivileged user whose engine it is.
become_rootless_user() {
  mkdir -p "$scratch/data"
  chown -R "$rootless_user" "$scratch"
  inside=(env "HOME=$scratch" "XDG_RUNTIME_DIR=$scratch"
    "${as_rootless_user[@]}")
}

# use_own_engine: one of this test's own, which is still to be launched.
use_own_engine() {
  engine_dir=$scratch/engine
  . tools/own_engine.sh
  mkdir -p "$engine_dir"
  [[ $variant != rootless ]] || prepare_rootless
  runtime=$engine_name:$engine_socket
}
