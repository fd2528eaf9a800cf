#!/usr/bin/env bash
# launch.sh [OPTION...] [--] [NODE OPTION...]: a node in a container, on a host
# with Docker or Podman and nothing else. Its image is built by the engine, once
# for these sources. Launching it again replaces a node that runs; what it has
# started goes on beside it. Ctrl-C ends the node; launch.sh stop ends one that
# was launched with --detach.
#
#   --engine E         docker, podman, or the engine's socket  [the first found]
#   --detach           return when the node is ready; it comes back after a
#                      reboot
#   --container NAME   its container                           [roscell-node]
#   --share DIR        a folder of this host that steps may read and write, in
#                      which the node sees files; can be repeated
#                      [/home /media /mnt /srv /tmp, as far as they exist]
#   --base IMAGE       what its image is made from             [debian:bookworm-slim]
#   --binary FOLDER    take what is built there, on a Debian 12 as IMAGE is
#   --video            with the skills that read cameras and videos (270 MB)
#   --build-only       no more than the image, whose name is printed
#   --help             this text
#
# Every other option is one of `roscell node`; --runtime is not, since skills of
# such a node always run in containers beside it, nor is --config.
set -euo pipefail
tree=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
ready_s=${ROSCELL_DEADLINE_S:-60}

usage() {
  echo "launch.sh: $*" >&2
  exit 2
}

fail() {
  echo "launch.sh: $*" >&2
  exit 1
}

# What the command line says.
engine= container=roscell-node base=debian:bookworm-slim binary= video=
detach=false build_only=false stop=false
shares=() node_options=() mounts=() volumes=()
data_dir= interface=

# absolute PATH: as the container sees it too.
absolute() {
  realpath -m -- "$1"
}

# Options of the node that name files of this host, which the container must
# see at the same place.
take_node_option() {
  local name=$1 value=$2
  case $name in
    --runtime) usage "no --runtime: a node in a container runs skills in" \
      "containers beside it; --engine chooses where. For processes install" \
      "the node on the host: docs/service.md" ;;
    --config) usage "no --config: the node's container would not see what the" \
      "file names; give its lines as options" ;;
    --data-dir) data_dir=$(absolute "$value"); return ;;
    --interface) interface=$value ;;
    --skills | --site-token) value=$(absolute "$value") mounts+=("$value:ro") ;;
    # The node writes beside it when its certificate is renewed.
    --socket | --identity) value=$(absolute "$value") mounts+=("$(dirname "$value")") ;;
    --invite) [[ ! -f $value ]] || value=$(< "$value") ;;
  esac
  node_options+=("$name" "$value")
}

[[ ${1:-} != stop ]] || { stop=true; shift; }
while [[ $# -gt 0 ]]; do
  option=$1
  # --option=value is --option value.
  [[ $option == --*=* ]] && set -- "${option%%=*}" "${option#*=}" "${@:2}"
  option=$1
  case $option in
    --runtime | --data-dir | --interface | --skills | --site-token | --socket | \
      --identity | --invite | --config | --engine | --container | --share | --base | --binary)
      [[ $# -gt 1 ]] || usage "$option wants a value" ;;
  esac
  case $option in
    -h | --help) sed -n '2,/^set /{/^set /!s/^# \{0,1\}//p}' "$0"; exit ;;
    --) ;;
    --detach) detach=true ;;
    --video) video=--video ;;
    --build-only) build_only=true ;;
    --engine) engine=$2; shift ;;
    --container) container=$2; shift ;;
    --share) shares+=("$(absolute "$2")"); shift ;;
    --base) base=$2; shift ;;
    --binary) binary=$2; shift ;;
    --runtime | --data-dir | --interface | --skills | --site-token | --socket | \
      --identity | --invite | --config)
      take_node_option "$option" "$2"; shift ;;
    *) node_options+=("$option") ;;
  esac
  shift
done

# The engine: its program, its socket, and whose it is.
user_dir=${XDG_RUNTIME_DIR:-/run/user/$(id -u)}

# usable PROGRAM SOCKET
usable() {
  command -v "$1" > /dev/null && [[ -S $2 && -w $2 ]]
}

# find_engine: sets $program and $socket, in the order of the node.
find_engine() {
  local candidate
  for candidate in "docker ${DOCKER_HOST:-}" docker\ /var/run/docker.sock \
    "docker $user_dir/docker.sock" "podman ${CONTAINER_HOST:-}" \
    "podman $user_dir/podman/podman.sock" podman\ /run/podman/podman.sock; do
    read -r program socket <<< "${candidate/unix:\/\//}"
    [[ -z $engine || $engine == "$program" ]] || continue
    usable "$program" "$socket" && return
  done
  local user=
  [[ $(id -u) -eq 0 ]] || user=' --user'
  fail "no container engine that $(id -un 2> /dev/null || id -u) may use:" \
    "install one and start it (systemctl start docker, or systemctl$user" \
    "enable --now podman.socket), join the group docker, or name its socket:" \
    "--engine SOCKET"
}

if [[ $engine == /* ]]; then
  socket=$engine program=docker
  [[ $engine == *podman* ]] && command -v podman > /dev/null && program=podman
  usable "$program" "$socket" || fail "$program cannot use the socket '$socket'"
else
  [[ $engine =~ ^(docker|podman|)$ ]] \
    || usage "--engine is docker, podman, or a socket, not '$engine'"
  find_engine
fi
engine_command=(docker -H "unix://$socket")
[[ $program == docker ]] || engine_command=(podman --remote --url "unix://$socket")

engine() {
  "${engine_command[@]}" "$@"
}

# The node leaves its cell in order, which takes it 5 s at most.
end_node() {
  engine stop -t 10 "$container" > /dev/null 2>&1 || true
  engine rm -f "$container" > /dev/null 2>&1 || true
}

if $stop; then
  engine inspect "$container" > /dev/null 2>&1 \
    || fail "there is no container '$container' (--container names another)"
  end_node
  exit
fi

. "$tree/tools/launch/image.sh"
build_image
rm -rf "$work"
if $build_only; then
  echo "$image"
  exit
fi

# Without a terminal the node says what is missing, and which ones there are.
if [[ -z $interface && -t 0 ]]; then
  . "$tree/tools/launch/interface.sh"
  interface=$(ask_for_interface) || usage "no interface was chosen"
  node_options+=(--interface "$interface")
fi

# An engine that is somebody's own has its user as root.
identity=(--user "$(id -u):$(id -g)" --group-add "$(stat -L -c %g "$socket")")
[[ $(stat -L -c %u "$socket") -eq 0 ]] || identity=()
if [[ -z $data_dir ]]; then
  data_dir=/var/lib/roscell
  [[ $(id -u) -eq 0 ]] \
    || data_dir=${XDG_STATE_HOME:-$HOME/.local/state}/roscell
fi
mkdir -p -m 0700 "$data_dir"
# What this user's nodes on this host share, wherever they run.
token=${ROSCELL_SITE_TOKEN:-}
if [[ -z $token ]]; then
  token=/etc/roscell/site.token
  [[ $(id -u) -eq 0 ]] \
    || token=${XDG_CONFIG_HOME:-$HOME/.config}/roscell/site.token
fi
token_dir=$(dirname "$token")
[[ -d $token_dir ]] || mkdir -p -m "$([[ $(id -u) -eq 0 ]] && echo 0755 || echo 0700)" "$token_dir"
mounts+=("$token_dir")
if [[ ${#shares[@]} -eq 0 ]]; then
  for folder in /home /media /mnt /srv /tmp; do
    [[ -d $folder ]] && shares+=("$folder")
  done
fi
for folder in "$data_dir" "${shares[@]}" "${mounts[@]}"; do
  volumes+=(--volume "${folder%:ro}:$folder")
done

# So that the node offers the GPUs that the engine can give to its skills.
gpus=()
if [[ $program == podman ]]; then
  compgen -G '/etc/cdi/nvidia*' > /dev/null \
    || compgen -G '/run/cdi/nvidia*' > /dev/null \
    && gpus=(--device nvidia.com/gpu=all)
elif engine info --format '{{json .Runtimes}}' 2> /dev/null \
  | grep '"nvidia"' > /dev/null; then
  gpus=(--gpus all --env NVIDIA_DRIVER_CAPABILITIES=utility)
fi

# The node is a program of the host that comes in a container: it has the host's
#   network   addresses, DDS, and the ports of the cell
#   ipc       shared memory, by which Fast DDS speaks with skills
#   pid       processes: what they use of CPU and GPUs, and whose it is
#   /dev      the devices that it offers to skills
#   socket    the engine, which starts skills beside it
# Its data directory and the shared folders are where they are on the host,
# because the engine mounts them into skills by these paths.
# Its limits are such that an engine under the usual ones may give them.
least() {
  printf '%s\n' "${1/unlimited/$2}" "$2" | sort -n | head -n 1
}
run_options=(--name "$container" --network host --ipc host --pid host
  "${identity[@]}" "${gpus[@]}"
  --ulimit "nofile=$(least "$(ulimit -Sn)" 65536)"
  --ulimit "nproc=$(least "$(ulimit -Su)" 4096)"
  --volume /dev:/dev --volume "$socket:$socket" "${volumes[@]}"
  --env "ROSCELL_TO=$data_dir/node.sock" --env "ROSCELL_SITE_TOKEN=$token")
node_command=(node --data-dir "$data_dir" --runtime "$program:$socket"
  "${node_options[@]}")

end_node
if ! $detach; then
  exec "${engine_command[@]}" run --rm "${run_options[@]}" "$image" \
    "${node_command[@]}"
fi

# The node says when it is ready in a pipe that it never waits for; its end is
# told there too.
ready=$data_dir/launch.ready
[[ -p $ready ]] || mkfifo -m 0600 "$ready"
exec {words}<> "$ready"
engine run --detach --restart unless-stopped "${run_options[@]}" \
  --entrypoint /bin/sh "$image" \
  -c 'exec roscell "$@" --ready-fd 5 5<> "$0"' "$ready" "${node_command[@]}" \
  > /dev/null || fail "the container cannot be started"
{ engine wait "$container"; echo gone >&"$words"; } > /dev/null 2>&1 &
said=
read -r -t "$ready_s" said <&"$words" || true
kill $! 2> /dev/null || true
[[ $said == READY=1 ]] && exit
engine logs "$container" >&2 || true
end_node
fail "the node did not start"
