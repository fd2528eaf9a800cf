#!/usr/bin/env bash
# Installs what building ROSCell needs, on Debian 12; with --containers a
# container engine too, with --to-package what makes Debian packages, with
# --with-tests also what its tests need. Quiet and quick when everything is there
# already; if it cannot install, one line says what to do.
set -euo pipefail

fail() {
  echo "install.sh: $*" >&2
  exit 1
}

case "${1:-}" in
  '' | --containers | --to-package | --with-tests) ;;
  -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit ;;
  *) echo "install.sh: unknown option $1 (--help tells more)" >&2; exit 2 ;;
esac

packages=(
  # To build: docs/decisions.md gives the reason for each.
  g++ cmake ninja-build ccache pkg-config python3
  libcaf-dev libfastrtps-dev nlohmann-json3-dev libvalijson-dev
  libboost-dev libssl-dev libsqlite3-dev libcli11-dev libspdlog-dev
  libncurses-dev libedit-dev libarchive-dev
  catch2
  # For the skills that look at images. OpenCV's parts instead of all of it.
  libapriltag-dev libeigen3-dev libpng-dev libturbojpeg0-dev libyaml-cpp-dev
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev
  libopencv-videoio-dev
  # For the demo, which reads and writes JSON.
  jq
)
if [[ "${1:-}" == --with-tests ]]; then
  packages+=(
    # To check: format, lint and fuzzers; namespaces, HTTP and JSON in scripts.
    clang clang-format clang-tidy libclang-rt-14-dev libfuzzer-14-dev
    iproute2 nftables curl procps
    # A terminal for `roscell top` that scripts can type into and read.
    tmux
    # Who scrapes `GET /metrics`, and a check of what it gets.
    prometheus
    # A browser for the dashboard, and what drives it.
    chromium chromium-driver python3-selenium
    # A DDS implementation that is not ours, and a look at the wire.
    cyclonedds-dev cyclonedds-tools tcpdump
    # The other engine. runc, because crun refuses hosts with both versions of
    # cgroups; catatonit holds the namespaces of a user's own Podman.
    podman runc netavark catatonit
    # A registry of images, and who may use it.
    docker-registry apache2-utils
  )
fi
if [[ "${1:-}" == --with-tests || "${1:-}" == --containers ]]; then
  # An engine, and what makes a base image for it.
  packages+=(docker.io mmdebstrap)
fi
if [[ "${1:-}" == --with-tests || "${1:-}" == --to-package ]]; then
  packages+=(debhelper help2man groff-base)
fi
if [[ "${1:-}" == --to-package ]]; then
  # To look at them, and to weigh them.
  packages+=(lintian mmdebstrap)
fi

command -v apt-get > /dev/null \
  || fail "this is no Debian: install by hand what $(realpath "$0") lists"
missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
remedy='fix that and run it again'
if [[ $(id -u) -ne 0 ]]; then
  root_runs="let root run: $(realpath "$0")${1:+ $1}"
  remedy+=", or $root_runs"
  command -v sudo > /dev/null \
    || fail "missing: ${missing[*]}; you are not root and there is no sudo:" \
      "$root_runs"
  as_root=(sudo)
  # Nobody can be asked for a password where there is no terminal.
  { : < /dev/tty; } 2> /dev/null || as_root=(sudo -n)
fi

log=$(mktemp -d /tmp/roscell-install.XXXXXX)
trap 'rm -rf "$log"' EXIT
echo "installing: ${missing[*]}"
# In one command, so that sudo asks but once. It waits for another apt. What an
# older list of packages names may still be there, so an update may fail.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive bash -c '
  apt-get -qq update > "$0/update" 2>&1
  exec apt-get -qq -o DPkg::Lock::Timeout=300 install -y \
    --no-install-recommends "$@"' "$log" "${missing[@]}" \
  < /dev/null > "$log/install" 2>&1 && exit
reason=$(grep -m 1 -E '^(E|sudo): ' "$log/install" || tail -n 1 "$log/install")
earlier=$(grep -m 1 -E '^[EW]: ' "$log/update" 2> /dev/null || true)
fail "cannot install: $reason${earlier:+ (before that: $earlier)}; $remedy"
