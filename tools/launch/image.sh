# The image of a node. To be sourced by launch.sh; build_image leaves its name in
# $image. $tree has the sources; $base, $binary and $video are launch.sh's options.

work=$(mktemp -d /tmp/roscell-launch.XXXXXX)
trap 'rm -rf "$work"' EXIT

# What goes into the image, which its name carries a hash of.
make_context() {
  if [[ -n $binary ]]; then
    "$tree/tools/launch/pack.sh" "$binary" "$work/out" $video
    cat > "$work/Dockerfile" << DOCKERFILE
FROM $base
COPY out /
DOCKERFILE
  else
    # What changes nothing in the image stays out of its hash.
    tar -C "$tree" --exclude='*.md' --exclude='*.sh' -c CMakeLists.txt \
      CMakePresets.json cmake include dds messages schemas actors skills client \
      embedding tools \
      | tar -C "$work" -x
    (cd "$tree" && cp --parents -t "$work" tools/install.sh tools/building.sh \
      tools/launch/pack.sh)
    cat > "$work/Dockerfile" << DOCKERFILE
FROM $base AS build
WORKDIR /src
COPY tools/install.sh tools/
RUN tools/install.sh
COPY . .
RUN cmake --preset release -DBUILD_TESTING=OFF && . tools/building.sh \\
 && ninja -C build/release -j "\$(build_jobs)" roscell instance_shim \\
    skills/all \\
 && tools/launch/pack.sh build/release /out $video
FROM $base
COPY --from=build /out /
DOCKERFILE
  fi
  cat >> "$work/Dockerfile" << 'DOCKERFILE'
ENV LD_LIBRARY_PATH=/usr/local/lib/roscell/lib
LABEL roscell.image=node
ENTRYPOINT ["/usr/local/bin/roscell"]
DOCKERFILE
}

# As tar sees it, but for owners and times.
hash_of_context() {
  tar -C "$work" --sort=name --owner=0 --group=0 --mtime=@0 -c . | sha256sum \
    | cut -c 1-16
}

build_image() {
  make_context
  image=roscell/node:$(hash_of_context)
  engine image inspect "$image" > /dev/null 2>&1 && return
  echo "building $image, once" >&2
  engine build --network host -t "$image" "$work" >&2 \
    || fail "the image cannot be built, see above; it needs the base image" \
      "'$base', here or in a registry (--base names another), and, but for" \
      "--binary, Debian's mirror"
}
