# A container engine of one's own, for tests and the demo: its own data, its own
# socket, and gone afterwards. Whatever other engine this machine has is not
# touched. To be sourced by a script that sets
#   engine_dir   a folder that may go afterwards
#   base_tar     file that keeps the root file system of the base image
# $engine_kind may hold docker, podman, or rootless, which is a Podman of an
# unprivileged user; $engine_inside a command prefix such as
# `nsenter --net=FILE`.

: "${engine_kind:=docker}"
engine_socket=$engine_dir.sock
[[ $engine_kind == docker ]] || engine_socket=$engine_dir/podman.sock
engine_inside=()
rootless_options=()
engine_deadline_s=${ROSCELL_DEADLINE_S:-60}

# A user who has no range of user ids maps itself alone, so that the owners of an
# image's files are all itself. --ipc host wants the message queues of a host
# that has them.
rootless_user=65534
as_rootless_user=(setpriv --reuid "$rootless_user" --regid "$rootless_user"
  --clear-groups)
if [[ $engine_kind == rootless ]]; then
  rootless_options=(--storage-driver overlay
    --storage-opt overlay.ignore_chown_errors=true)
  engine_inside=(unshare -m bash -c '
    mountpoint -q /dev/mqueue || mount -t mqueue mqueue /dev/mqueue
    exec "$@"' - env "HOME=$engine_dir/home" "XDG_RUNTIME_DIR=$engine_dir/home"
    "${as_rootless_user[@]}")
fi

# Why there can be no engine here, in $engine_dir.reason, and false.
no_engine_here() {
  echo "$*" > "$engine_dir.reason"
  return 1
}

# The Debian root file system that stands for the base image that a user with a
# registry would pull. Made from the Debian mirror, once, whoever else wants it.
make_base_tar() {
  [[ -s $base_tar ]] && return
  mkdir -p "$(dirname "$base_tar")"
  (
    flock 9
    [[ -s $base_tar ]] || bootstrap_base_tar
  ) 9> "$base_tar.lock"
}

bootstrap_base_tar() {
  mmdebstrap --quiet --variant=minbase --format=tar \
    --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' \
    bookworm "$base_tar.part" > "$engine_dir.mmdebstrap" 2>&1 \
    && mv "$base_tar.part" "$base_tar"
}

# Docker's client speaks with Podman too.
engine() {
  docker -H "unix://$engine_socket" "$@"
}

launch_dockerd() {
  setsid "${engine_inside[@]}" dockerd --data-root "$engine_dir/root" \
    --exec-root "$engine_dir/exec" -p "$engine_dir/pid" \
    -H "unix://$engine_socket" --bridge=none --iptables=false \
    --ip6tables=false "$@" > "$engine_dir/log" 2>&1 < /dev/null & echo $!
}

# runc, because Debian 12's crun refuses hosts with both versions of cgroups;
# cgroupfs and files, because there need be no systemd.
launch_podman() {
  cat > "$engine_dir/containers.conf" << CONF
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
lock_type = "file"
CONF
  # It leaves a copy of each image that is loaded. Not in $engine_dir, which may
  # be a small disk.
  mkdir -p -m 1777 "$engine_dir.temporary"
  TMPDIR=$engine_dir.temporary CONTAINERS_CONF=$engine_dir/containers.conf \
    setsid "${engine_inside[@]}" \
    podman --root "$engine_dir/root" --runroot "$engine_dir/exec" \
    --tmpdir "$engine_dir/tmp" --log-level info "${rootless_options[@]}" "$@" \
    system service --time 0 "unix://$engine_socket" \
    > "$engine_dir/log" 2>&1 < /dev/null &
  echo $! | tee "$engine_dir/pid"
}

# launch_engine [OPTION...]: starts the engine and waits until it can be asked.
launch_engine() {
  local daemon
  rm -f "$engine_socket"
  # No job of whoever starts it: it outlives the test that does.
  case $engine_kind in
    docker) daemon=$(launch_dockerd "$@") ;;
    *) daemon=$(launch_podman "$@") ;;
  esac
  grep -m 1 -qE 'API (service )?listen(ing)? on' < <(exec timeout \
    "$engine_deadline_s" tail -n +1 --pid="$daemon" -f "$engine_dir/log" \
    2>/dev/null)
}

# What the unprivileged user of a rootless engine needs beside the program.
prepare_rootless() {
  mkdir -p "$engine_dir/home" /dev/mqueue
  chown -R "$rootless_user:$rootless_user" "$engine_dir"
  chmod a+rx "$(dirname "$engine_dir")"
  "${as_rootless_user[@]}" unshare -Ur true 2> "$engine_dir/userns" \
    || no_engine_here "no user namespaces here: $(cat "$engine_dir/userns")"
}

start_engine() {
  local program=podman
  [[ $engine_kind == docker ]] && program=dockerd
  [[ $(id -u) -eq 0 ]] || no_engine_here "an engine for tests needs root" \
    || return
  command -v docker > /dev/null || no_engine_here "docker is missing" || return
  command -v "$program" > /dev/null || no_engine_here "$program is missing" \
    || return
  make_base_tar || no_engine_here "no base image can be made:" \
    "$(tail -n 1 "$engine_dir.mmdebstrap")" || return
  mkdir -p "$engine_dir"
  [[ $engine_kind != rootless ]] || prepare_rootless || return
  launch_engine || no_engine_here "$program does not start here:" \
    "$(grep -v level=info "$engine_dir/log" | tail -n 1)" || return
  engine import "$base_tar" debian:bookworm-slim > /dev/null || return
  rm -f "$engine_dir.temporary"/api_load.tar*
}

# end_engine [SIGNAL]: ends the engine and waits for its end. A Podman may be
# several processes; its containers are in sessions of their own.
end_engine() {
  local daemon group=
  [[ $engine_kind == docker ]] || group=-
  daemon=$(cat "$engine_dir/pid" 2>/dev/null) || return 0
  kill "-${1:-TERM}" -- "$group$daemon" 2>/dev/null
  timeout "$engine_deadline_s" tail --pid="$daemon" -f /dev/null
  rm -f "$engine_dir/pid"
}

# Ends the engine with all of its containers.
stop_engine() {
  engine ps -aq 2>/dev/null | xargs -r docker -H "unix://$engine_socket" rm -f \
    > /dev/null 2>&1
  end_engine
  rm -rf "$engine_dir.temporary"
  # A killed dockerd leaves its containerd.
  local rest
  rest=$(cat "$engine_dir/exec/containerd/containerd.pid" 2>/dev/null) \
    && kill "$rest" 2>/dev/null \
    && timeout "$engine_deadline_s" tail --pid="$rest" -f /dev/null
  # What holds the user namespace of a rootless Podman.
  rest=$(cat "$engine_dir/tmp/pause.pid" 2>/dev/null) && kill "$rest"
  grep -o " $engine_dir/[^ ]*" /proc/mounts | sort -r \
    | xargs -r umount -l 2>/dev/null
}
