# A minimal Debian 12 in which packages of ours can be installed without a
# network. To be sourced in the root of the tree.

# clean_root NAME INCLUDE FILE.deb...: prints the tar file of a minimal Debian
# with the packages INCLUDE (separated by commas, may be empty), and with what
# these files need beyond that in apt's cache. It is kept under that name, and
# made from Debian's mirror when there is none, or when they need others.
clean_root() {
  local folder=$PWD/build/base-images name=$1 include=$2 needs root
  shift 2
  needs=$(for package in "$@"; do dpkg-deb -f "$package" Depends; done)
  root=$folder/$name-$(sha256sum <<< "$include $needs" | cut -c 1-16).tar.gz
  mkdir -p "$folder"
  (
    flock 9
    [[ -s $root ]] || bootstrap_root "$@"
  ) 9> "$folder/$name.lock" && echo "$root"
}

# bootstrap_root FILE.deb...: makes $root of clean_root.
bootstrap_root() {
  # Two builds of one tree may take turns.
  find "$folder" -name "$name-*.tar*" -printf '%T@ %p\n' | sort -rn \
    | tail -n +2 | cut -d ' ' -f 2- | xargs -r rm
  local part=$folder/part.$name.tar.gz # By whose end it is packed.
  mmdebstrap --quiet --variant=minbase ${include:+--include="$include"} \
    --format=tar --skip=cleanup/apt \
    --dpkgopt='path-exclude=/usr/share/locale/*' \
    --customize-hook='mkdir "$1/packages"' \
    --customize-hook="cp $(printf '%q ' "$@") \"\$1/packages\"" \
    --customize-hook='chroot "$1" sh -c "apt-get -q install -y \
      --no-install-recommends --download-only /packages/*.deb"' \
    --customize-hook='rm -r "$1/packages"' \
    bookworm "$part" > "$root.log" 2>&1 \
    || { grep -E '^[EW]: ' "$root.log" | tail -n 1 >&2; return 1; }
  mv "$part" "$root"
  rm "$root.log"
}
