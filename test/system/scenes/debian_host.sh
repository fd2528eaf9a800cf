# A Debian with systemd that a test has for itself: a root file system of its
# own, in namespaces of its own. To be sourced.

debian_root=$scratch/debian

# need_debian_host: skips the test where there can be none.
need_debian_host() {
  [[ $(id -u) -eq 0 ]] || skip "a Debian of its own needs root"
  command -v mmdebstrap dh > /dev/null || skip "mmdebstrap or debhelper is missing"
  cgroups=$(findmnt -nt cgroup2 -o TARGET | head -n 1)
  [[ -n $cgroups ]] || skip "systemd needs cgroups of version 2"
  cgroup=$cgroups/roscell-$(basename "$scratch")
  mkdir "$cgroup" 2> /dev/null || skip "no cgroup can be made in $cgroups"
}

# What systemd expects of whoever starts it in namespaces; then systemd.
boot_debian() {
  local device
  mount --make-rprivate /
  mount --bind "$debian_root" "$debian_root"
  cd "$debian_root" || exit
  mount -t proc proc proc
  mount -t sysfs -o ro sysfs sys
  mount -t cgroup2 cgroup2 sys/fs/cgroup
  mount -t tmpfs tmpfs run
  mount -t tmpfs tmpfs tmp
  mount -t tmpfs tmpfs dev
  mkdir dev/pts dev/shm
  mount -t devpts -o newinstance,ptmxmode=0666 devpts dev/pts
  mount -t tmpfs tmpfs dev/shm
  ln -s pts/ptmx dev/ptmx
  for device in null zero full random urandom tty; do
    touch "dev/$device"
    mount --bind "/dev/$device" "dev/$device"
  done
  exec chroot . /usr/bin/env -i container=test \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd --show-status=0
}

# start_debian TAR: boots what is in the file, and waits until it runs.
start_debian() {
  local said= unshare
  mkdir "$debian_root"
  tar -C "$debian_root" -xf "$1"
  mkfifo "$debian_root/booted"
  exec {booted}<> "$debian_root/booted"
  cat > "$debian_root/etc/systemd/system/booted.service" << 'UNIT'
[Service]
Type=oneshot
ExecStart=sh -c 'echo booted > /booted'
[Install]
WantedBy=multi-user.target
UNIT
  ln -s ../booted.service -t "$debian_root/etc/systemd/system/multi-user.target.wants"
  mkdir -p "$debian_root/etc/systemd/system.conf.d"
  cat > "$debian_root/etc/systemd/system.conf.d/sanitizers.conf" << CONF
[Manager]
DefaultEnvironment="ASAN_OPTIONS=${ASAN_OPTIONS:-}"
CONF
  export -f boot_debian
  export debian_root
  # Its cgroup is the root of what systemd sees.
  bash -c 'echo $$ > "$0/cgroup.procs"; exec unshare --fork --kill-child --pid \
    --mount --uts --ipc --net --cgroup bash -c boot_debian' "$cgroup" \
    > "$scratch/boot.log" 2>&1 < /dev/null &
  unshare=$!
  echo "$unshare" >> "$scratch/pids"
  { tail --pid="$unshare" -f /dev/null; echo gone >&"$booted"; } &
  read -r -t "$deadline_s" said <&"$booted" || true
  [[ $said == booted ]] \
    || skip "systemd does not boot here: $(tail -n 1 "$scratch/boot.log")"
  init=$(pgrep -P "$unshare")
}

# on_debian COMMAND...: there.
on_debian() {
  nsenter -t "$init" -a -r -w env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ASAN_OPTIONS="${ASAN_OPTIONS:-}" "$@"
}

end_debian() {
  [[ -z ${init:-} ]] \
    || on_debian journalctl -q -b > "$scratch/journal.log" 2> /dev/null
  [[ -z ${init:-} ]] || kill -KILL "$init"
  [[ -z ${init:-} ]] || timeout "$deadline_s" tail --pid="$init" -f /dev/null
  [[ -z ${cgroup:-} ]] || find "$cgroup" -depth -type d -exec rmdir {} + 2> /dev/null
}
