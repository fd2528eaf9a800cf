#!/usr/bin/env bash
# pack.sh BUILD OUT [--video]: what the image of a node has beside its base, as
# a file tree OUT: the node, the instance shim, the skills, and the libraries
# that these load, but for the C library, which is the base's. With --video also
# the skills that read cameras and videos, whose libraries weigh 270 MB.
set -euo pipefail

build=$1 out=$2/usr/local video=${3:-}
mkdir -p "$out/bin" "$out/lib/roscell/skills" "$out/lib/roscell/lib"
cp -p "$build/bin/roscell" "$out/bin"
# It is static, and runs in the containers of skills.
cp -p "$build/bin/roscell-instance-shim" "$out/lib/roscell"
for descriptor in "$build"/skills/*/skill.*; do
  skill=$(dirname "$descriptor")
  [[ $skill == *video* && $video != --video ]] \
    || cp -rpT "$skill" "$out/lib/roscell/skills/$(basename "$skill")"
done
find "$out/bin" "$out/lib/roscell/skills" -type f -perm -u+x \
  -exec strip --strip-debug {} + 2> /dev/null || true
find "$out/bin" "$out/lib/roscell/skills" -type f -perm -u+x -exec ldd {} + \
  | grep -oE '=> /[^ ]+' | cut -c 4- | sort -u \
  | grep -vE '/(ld-linux.*|lib(c|m|dl|rt|pthread|resolv)\.so\.[0-9]+)$' \
  | xargs -r cp -Lpt "$out/lib/roscell/lib"
