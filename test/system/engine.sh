# A Docker engine of the tests' own: its own data, its own socket, and gone
# afterwards. Whatever other engine this machine has is not touched.

engine_socket=$suite/engine.sock
engine_dir=$suite/engine

# Why there can be no engine here, in $suite/skipped, and false.
no_engine_here() {
  echo "$*" > "$suite/skipped"
  return 1
}

# The Debian root file system that stands for the base image a user would pull.
# Made from the Debian mirror once for all builds of this tree.
base_tar=$ROSCELL_BUILD/../test-images/bookworm.tar
make_base_tar() {
  [[ -s $base_tar ]] && return
  mkdir -p "$(dirname "$base_tar")"
  mmdebstrap --quiet --variant=minbase \
    --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' \
    bookworm "$base_tar.part" > "$suite/mmdebstrap.log" 2>&1 \
    && mv "$base_tar.part" "$base_tar"
}

engine() {
  docker -H "unix://$engine_socket" "$@"
}

# launch_engine [OPTION...]: starts dockerd and waits until it can be asked.
launch_engine() {
  local daemon
  rm -f "$engine_socket"
  # No job of the test that starts it: it outlives the test.
  daemon=$(setsid dockerd --data-root "$engine_dir/root" \
    --exec-root "$engine_dir/exec" -p "$engine_dir/pid" \
    -H "unix://$engine_socket" --bridge=none --iptables=false \
    --ip6tables=false "$@" > "$engine_dir/log" 2>&1 < /dev/null & echo $!)
  grep -m 1 -q 'API listen on' < <(exec timeout "$deadline_s" \
    tail -n +1 --pid="$daemon" -f "$engine_dir/log" 2>/dev/null)
}

start_engine() {
  [[ $(id -u) -eq 0 ]] || no_engine_here "a Docker engine needs root" || return
  command -v dockerd > /dev/null || no_engine_here "dockerd is missing" \
    || return
  make_base_tar || no_engine_here "no base image can be made:" \
    "$(tail -n 1 "$suite/mmdebstrap.log")" || return
  mkdir -p "$engine_dir"
  launch_engine || no_engine_here "dockerd does not start here:" \
    "$(grep -v level=info "$engine_dir/log" | tail -n 1)" || return
  engine import "$base_tar" debian:bookworm-slim > /dev/null
}

# end_engine [SIGNAL]: ends dockerd and waits for its end.
end_engine() {
  local daemon
  daemon=$(cat "$engine_dir/pid" 2>/dev/null) || return 0
  kill "-${1:-TERM}" "$daemon" 2>/dev/null
  timeout "$deadline_s" tail --pid="$daemon" -f /dev/null
  rm -f "$engine_dir/pid"
}

# Ends the engine with all of its containers.
stop_engine() {
  engine ps -aq 2>/dev/null | xargs -r docker -H "unix://$engine_socket" rm -f \
    > /dev/null 2>&1
  end_engine
  # A killed dockerd leaves its containerd.
  local rest
  rest=$(cat "$engine_dir/exec/containerd/containerd.pid" 2>/dev/null) \
    && kill "$rest" 2>/dev/null \
    && timeout "$deadline_s" tail --pid="$rest" -f /dev/null
  grep -o " $engine_dir/[^ ]*" /proc/mounts | sort -r \
    | xargs -r umount -l 2>/dev/null
}

# For a test: skips it if there is no engine, and uses it if there is one.
use_engine() {
  [[ -f $suite/skipped ]] && skip "$(cat "$suite/skipped")"
  [[ -S $engine_socket ]] || fail "$(cat "$suite/before_all.output")"
  # What a failed test has left.
  engine ps -aq | xargs -r docker -H "unix://$engine_socket" rm -f > /dev/null
  runtime=docker:$engine_socket
  # The sanitizers' own memory is many times that of the skill.
  local text
  text=$(jq '.models[].deployments[].resources.memory_mib = 1024' \
    "$skills/echo/skill.json")
  echo "$text" > "$skills/echo/skill.json"
}
