# A Docker engine of one's own, for tests and the demo: its own data, its own
# socket, and gone afterwards. Whatever other engine this machine has is not
# touched. To be sourced by a script that sets
#   engine_dir   a folder that may go afterwards
#   base_tar     file that keeps the root file system of the base image
# $engine_inside may hold a command prefix such as `nsenter --net=FILE`.

engine_socket=$engine_dir.sock
engine_inside=()
engine_deadline_s=${ROSCELL_DEADLINE_S:-60}

# Why there can be no engine here, in $engine_dir.reason, and false.
no_engine_here() {
  echo "$*" > "$engine_dir.reason"
  return 1
}

# The Debian root file system that stands for the base image that a user with a
# registry would pull. Made from the Debian mirror, once.
make_base_tar() {
  [[ -s $base_tar ]] && return
  mkdir -p "$(dirname "$base_tar")"
  mmdebstrap --quiet --variant=minbase --format=tar \
    --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' \
    bookworm "$base_tar.part" > "$engine_dir.mmdebstrap" 2>&1 \
    && mv "$base_tar.part" "$base_tar"
}

engine() {
  docker -H "unix://$engine_socket" "$@"
}

# launch_engine [OPTION...]: starts dockerd and waits until it can be asked.
launch_engine() {
  local daemon
  rm -f "$engine_socket"
  # No job of whoever starts it: it outlives the test that does.
  daemon=$(setsid "${engine_inside[@]}" dockerd --data-root "$engine_dir/root" \
    --exec-root "$engine_dir/exec" -p "$engine_dir/pid" \
    -H "unix://$engine_socket" --bridge=none --iptables=false \
    --ip6tables=false "$@" > "$engine_dir/log" 2>&1 < /dev/null & echo $!)
  grep -m 1 -q 'API listen on' < <(exec timeout "$engine_deadline_s" \
    tail -n +1 --pid="$daemon" -f "$engine_dir/log" 2>/dev/null)
}

start_engine() {
  [[ $(id -u) -eq 0 ]] || no_engine_here "a Docker engine needs root" || return
  command -v dockerd > /dev/null || no_engine_here "dockerd is missing" \
    || return
  make_base_tar || no_engine_here "no base image can be made:" \
    "$(tail -n 1 "$engine_dir.mmdebstrap")" || return
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
  timeout "$engine_deadline_s" tail --pid="$daemon" -f /dev/null
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
    && timeout "$engine_deadline_s" tail --pid="$rest" -f /dev/null
  grep -o " $engine_dir/[^ ]*" /proc/mounts | sort -r \
    | xargs -r umount -l 2>/dev/null
}
