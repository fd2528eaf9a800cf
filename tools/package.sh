#!/usr/bin/env bash
# package.sh [OPTION...] [PACKAGE...]: makes Debian packages of these sources, all
# of them if none is named: builds what is missing in build/release, packs it,
# and lets lintian look at it.
#
#   --output DIR    where they go                       [build/packages]
#   --build FOLDER  take what is built there, neither compressed nor looked at by
#                   lintian: quick, for tests
#   --sizes         instead, a table of what weighs what of all that they install on
#                   a minimal Debian without recommended packages
#   --help          this text
set -euo pipefail

fail() {
  echo "package.sh: $*" >&2
  exit 1
}

output= build= sizes=false
export DH_OPTIONS=
while [[ $# -gt 0 ]]; do
  case $1 in
    --output | --build)
      [[ $# -gt 1 ]] || { echo "package.sh: $1 wants a value" >&2; exit 2; }
      printf -v "${1#--}" %s "$(realpath -m "$2")"; shift ;;
    --sizes) sizes=true ;;
    -h | --help) sed -n '2,/^set /{/^set /!s/^# \{0,1\}//p}' "$0"; exit ;;
    -*) echo "package.sh: unknown option $1 (--help tells more)" >&2; exit 2 ;;
    *) DH_OPTIONS+=" -p$1" ;;
  esac
  shift
done

cd "$(dirname "$0")/.."
. tools/building.sh
may_build || exit 1
: "${output:=$PWD/build/packages}"
mkdir -p "$output"
work=$(mktemp -d /tmp/roscell-package.XXXXXX)
trap 'rm -rf "$work"' EXIT
if $sizes; then
  . tools/packaging/sizes.sh
  exit
fi

# In a copy, so that what debhelper leaves is not in the tree.
pack() {
  mkdir "$work/tree" "$work/packages"
  cp -r --parents -t "$work/tree" debian docs/examples
  (cd "$work/tree" \
    && BUILD=$build PACKAGES=$work/packages debian/rules binary) \
    > "$output/packing.log" 2>&1 \
    || fail "it cannot be packed: $(tail -n 1 "$output/packing.log"), see" \
      "$output/packing.log"
  rm -f "$output"/*.deb
  mv -t "$output" "$work"/packages/*.deb
}

if [[ -n $build ]]; then
  export DPKG_DEB_COMPRESSOR_TYPE=none
  pack
  exit
fi
tools/install.sh --to-package || exit 1
build roscell roscell_texts instance_shim unpack_skill skills/all render_scenes \
  compare_poses || exit 1
build=$PWD/build/release
pack
lintian --allow-root --fail-on error,warning "$output"/*.deb || fail "lintian is not content"
ls -sh "$output"/*.deb
