#!/usr/bin/env bash
# Installs what building ROSCell needs, on Debian 12; with --containers a
# container engine too, with --with-tests also what its tests need. Quiet and
# quick when everything is there already.
set -euo pipefail

packages=(
  # To build: docs/decisions.md gives the reason for each.
  g++ cmake ninja-build ccache pkg-config
  libcaf-dev libfastrtps-dev nlohmann-json3-dev libvalijson-dev
  libboost-dev libssl-dev libsqlite3-dev libcli11-dev libspdlog-dev catch2
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
    iproute2 nftables curl procps python3-minimal
    # A DDS implementation that is not ours, and a look at the wire.
    cyclonedds-dev cyclonedds-tools tcpdump
  )
fi
if [[ "${1:-}" == --with-tests || "${1:-}" == --containers ]]; then
  # An engine, and what makes a base image for it.
  packages+=(docker.io mmdebstrap)
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

sudo=()
[[ $(id -u) -eq 0 ]] || sudo=(sudo)
echo "installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get update -qq
"${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" \
  >/dev/null
