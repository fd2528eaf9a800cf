#!/usr/bin/env bash
# booted_debian.sh [OPTION...] SCRIPT [FILE...]: boots a Debian 12 with systemd under
# qemu, runs a bash script there as root, and prints what it says. It is for what
# namespaces do not have: cgroups of version 2 with controllers, units with all
# that systemd takes away, CAN, other users. The exit code is the script's, 77
# where there is no qemu. Its folder is /payload; the files lie beside it. What the
# packages among them (*.deb) need is there, and there is no network.
#
#   --deadline S  seconds until it is given up        [1200]
#   --memory MIB  of the machine                      [2048]
#   --kvm         let the processor do it; not each machine with /dev/kvm can
#   --console     print what its kernel and systemd say, too
#   --fresh       make its disk anew: it is kept in ~/.cache/roscell/booted
#   --help        this text
#
# Without --kvm the processor is emulated: it boots in a minute, and is some ten
# times slower than this machine.
set -euo pipefail

deadline=1200 memory=2048 console=false fresh=false kvm=false
while [[ ${1:-} == -* ]]; do
  case $1 in
    --deadline) deadline=$2; shift ;;
    --memory) memory=$2; shift ;;
    --console) console=true ;;
    --fresh) fresh=true ;;
    --kvm) kvm=true ;;
    -h | --help) sed -n '2,/^set /{/^set /!s/^# \{0,1\}//p}' "$0"; exit ;;
    *) echo "booted_debian.sh: unknown option $1 (--help tells more)" >&2; exit 2 ;;
  esac
  shift
done
[[ $# -gt 0 ]] || { echo "booted_debian.sh: name a script" >&2; exit 2; }

skip() {
  echo "SKIP: $*"
  exit 77
}

[[ $(id -u) -eq 0 ]] || skip "a disk with files of root's is made by root"
for tool in qemu-system-x86_64 mmdebstrap mkfs.ext4; do
  command -v "$tool" > /dev/null \
    || skip "there is no $tool; apt install qemu-system-x86 mmdebstrap e2fsprogs"
done

cache=${XDG_CACHE_HOME:-$HOME/.cache}/roscell/booted
work=$(mktemp -d /tmp/roscell-booted.XXXXXX)
trap 'rm -rf "$work"' EXIT

# Packages that every script may want, and those that the given ones depend on.
wanted_packages() {
  local file
  printf '%s\n' systemd systemd-sysv dbus udev kmod initramfs-tools \
    linux-image-amd64 adduser procps iproute2 can-utils init-system-helpers
  for file in "$@"; do
    [[ $file != *.deb ]] || dpkg-deb -f "$file" Depends | tr ',' '\n' \
      | sed 's/|.*//; s/([^)]*)//; s/[[:space:]]//g' | grep -v '^roscell'
  done
}

# What runs the script as soon as the machine is up.
add_runner() {
  cat > "$1/etc/systemd/system/payload.service" << 'UNIT'
[Unit]
Wants=dbus.service
After=dbus.service multi-user.target
DefaultDependencies=no
[Service]
ExecStart=/usr/local/sbin/run-payload
UNIT
  cat > "$1/etc/systemd/system/payload.timer" << 'UNIT'
[Timer]
OnBootSec=1
AccuracySec=100ms
[Install]
WantedBy=timers.target
UNIT
  mkdir -p "$1/etc/systemd/system/timers.target.wants" "$1/payload"
  ln -sf ../payload.timer -t "$1/etc/systemd/system/timers.target.wants"
  cat > "$1/usr/local/sbin/run-payload" << 'RUN'
#!/bin/bash
exec > /dev/ttyS1 2>&1 < /dev/null
stty -F /dev/ttyS1 -opost
mount -o ro /dev/vdb /payload
cd /payload
export HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/sbin:/usr/bin:/sbin:/bin
bash ./script
echo "exit code $?"
sync
systemctl poweroff -ff > /dev/null 2>&1
RUN
  chmod +x "$1/usr/local/sbin/run-payload"
  printf '%s\n' '/dev/vda / ext4 defaults 0 1' > "$1/etc/fstab"
  echo booted > "$1/etc/hostname"
}

# make_disk NAME FILE...: the kernel and the disk NAME, in the cache.
make_disk() {
  local root=$work/root packages
  packages=$(wanted_packages "${@:2}" | sort -u | paste -sd ,)
  echo "making a disk with Debian, which takes some minutes" >&2
  # What a disk of qemu needs to be found is all that its initrd has.
  nice -n 10 mmdebstrap --quiet --variant=minbase --format=directory \
    --include="$packages" \
    --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' \
    --essential-hook='mkdir -p "$1/etc/initramfs-tools/conf.d"' \
    --essential-hook='echo MODULES=list > "$1/etc/initramfs-tools/conf.d/list"' \
    --essential-hook='printf "%s\n" virtio_pci virtio_blk ext4 > "$1/etc/initramfs-tools/modules"' \
    bookworm "$root" > "$work/mmdebstrap.log" 2>&1 \
    || skip "no Debian can be made: $(grep -E '^[EW]: ' "$work/mmdebstrap.log" | tail -n 1)"
  add_runner "$root"
  cp "$(ls "$root"/boot/vmlinuz-* | head -n 1)" "$work/kernel"
  cp "$(ls "$root"/boot/initrd.img-* | head -n 1)" "$work/initrd"
  rm -rf "$root"/boot/* "$root"/var/cache/apt/archives/*.deb
  mkfs.ext4 -q -d "$root" "$work/disk" 4G
  rm -rf "$root" "$cache/$1"
  mkdir -p "$cache/$1"
  mv -t "$cache/$1" "$work/kernel" "$work/initrd" "$work/disk"
}

name=$({ wanted_packages "${@:2}" | sort -u; declare -f add_runner make_disk; } \
  | sha256sum | cut -c 1-16)
mkdir -p "$cache"
(
  flock 9
  [[ -s $cache/$name/disk ]] && ! $fresh || make_disk "$name" "$@"
) 9> "$cache/lock" || exit

mkdir "$work/payload"
cp "$1" "$work/payload/script"
[[ $# -eq 1 ]] || cp -rt "$work/payload" "${@:2}"
mkfs.ext4 -q -d "$work/payload" "$work/files" \
  "$(($(du -sm "$work/payload" | cut -f 1) * 5 / 4 + 16))M"

accel=tcg,thread=multi cpu=max
! $kvm || accel=kvm cpu=host
timeout "$deadline" qemu-system-x86_64 -accel "$accel" -cpu "$cpu" -smp 2 \
  -m "$memory" -display none -monitor none -nic none -no-reboot \
  -kernel "$cache/$name/kernel" -initrd "$cache/$name/initrd" \
  -append "root=/dev/vda rw console=ttyS0 quiet ${BOOT_OPTIONS:-}" \
  -drive "file=$cache/$name/disk,format=raw,if=virtio,snapshot=on" \
  -drive "file=$work/files,format=raw,if=virtio,readonly=on" \
  -serial "$($console && echo "file:/dev/stderr" || echo "file:$work/console")" \
  -serial stdio < /dev/null > >(tee "$work/said") || true
code=$(sed -n 's/^exit code \([0-9]*\)\r*$/\1/p' "$work/said" | tail -n 1)
if [[ -z $code ]]; then
  echo "booted_debian.sh: no end within $deadline s; its console:" >&2
  tail -n 20 "$work/console" >&2 || true
  exit 124
fi
exit "$code"
