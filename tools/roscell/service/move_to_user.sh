#!/bin/sh
# move-to-user: gives the nodes of this host, which run as root since before they
# had a user of their own, to the user roscell: data directories, tokens and
# logs. They are stopped meanwhile. It refuses as long as anything runs that a
# node has started as root, and names it: such a program would have no node any
# more that may end it. To be run as root.
set -eu
here=$(dirname "$0")
roscell=$here/../../bin/roscell
drop_ins='roscell.service.d roscell@.service.d'

fail() {
  echo "move-to-user: $*" >&2
  exit 1
}

data_dirs() {
  for folder in /var/lib/roscell /var/lib/roscell-nodes/*; do
    [ ! -e "$folder/state.db" ] || echo "$folder"
  done
}

# The instances of a node that may run, "INSTANCE PID" each, by their records.
processes_of() {
  for record in "$1"/instances/*/pid; do
    words=$(readlink "$record" || cat "$record" 2> /dev/null) || continue
    pid=${words%% *} start=$(echo "$words" | cut -d' ' -f2)
    [ "$(cut -d' ' -f22 "/proc/$pid/stat" 2> /dev/null)" = "$start" ] || continue
    echo "$(basename "$(dirname "$record")") process $pid"
  done
}

# Those of a node that are containers, of whatever engine is here.
containers() {
  for engine in docker podman; do
    command -v "$engine" > /dev/null || continue
    timeout 20 "$engine" ps -q --filter label=roscell.node \
      --format "{{.Names}} $engine" 2> /dev/null || true
  done
}

left() {
  data_dirs | while read -r folder; do processes_of "$folder"; done
  containers
}

refuse_what_is_left() {
  all=$(left)
  [ -z "$all" ] || fail "these instances were started by root, and run on:
$(echo "$all" | sed 's/^/  /')
end their tasks (\`roscell tasks\`, \`roscell stop TASK\`), or move them away
(\`roscell drain NODE\`); then try again"
}

# What root's nodes prove themselves with he may read; it stays root's.
take_tokens() {
  for token in /etc/roscell/*.token; do
    [ ! -f "$token" ] || { chgrp roscell "$token" && chmod g+r "$token"; }
  done
  [ -f /etc/roscell/site.token ] || return 0
  mine=/var/lib/roscell/.config/roscell
  install -d -o roscell -g roscell -m 0700 /var/lib/roscell/.config "$mine"
  [ -e "$mine/site.token" ] \
    || install -o roscell -g roscell -m 0600 /etc/roscell/site.token "$mine"
}

# Whoever may speak to Docker is root of this host, so it is his only where it
# was the nodes' already.
keep_engine() {
  getent group docker > /dev/null && docker ps -aq --filter label=roscell.node \
    2> /dev/null | grep -q . || return 0
  adduser --quiet roscell docker
  echo "move-to-user: roscell is in the group docker now, for its containers;" \
    "that is as much as root"
}

[ "$(id -u)" -eq 0 ] || fail "only root can do that"
found=false
for folder in $drop_ins; do
  [ ! -e "/etc/systemd/system/$folder/as-root.conf" ] || found=true
done
$found || fail "the nodes of this host have their user already"
refuse_what_is_left
"$here/make-user"
units=$(systemctl list-units --plain --no-legend --state=active,activating \
  'roscell.service' 'roscell@*.service' | cut -d' ' -f1)
[ -z "$units" ] || systemctl stop $units
trap '[ -z "$units" ] || systemctl start $units' EXIT
# Something may have been started meanwhile.
refuse_what_is_left
keep_engine
data_dirs | while read -r folder; do chown -R roscell:roscell "$folder"; done
take_tokens
rmdir /dev/shm/roscell-0 2> /dev/null || true
for folder in $drop_ins; do
  rm -f "/etc/systemd/system/$folder/as-root.conf"
  rmdir "/etc/systemd/system/$folder" 2> /dev/null || true
done
systemctl daemon-reload
echo "move-to-user: the nodes of this host run as the user roscell now"
