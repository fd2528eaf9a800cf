# The hardened unit: what skills are to do works under it, and what they are not to
# do does not. Files: scene.sh and the packages.
. ./scene.sh

say "a new install has a user of its own"
install_packages ./*.deb
expect "the user's groups" "$(id -nG roscell | tr ' ' '\n' | sort \
  | grep -cE '^(roscell|video|dialout|plugdev|render)$')" 5
adduser --quiet --disabled-password --gecos '' ann
adduser --quiet --disabled-password --gecos '' bob
adduser --quiet ann roscell
chmod 0755 /home/ann
install -d -o ann -m 0777 /home/ann/pictures /data
echo hello > /home/ann/pictures/in.txt
modprobe vcan
ip link add vcan0 type vcan && ip link set vcan0 up
modprobe vivid || true
[[ -e /dev/video0 ]] || { mknod -m 0660 /dev/video0 c 1 5; chgrp video /dev/video0; }

# What each step writes into its log is what its host lets it do.
mkdir -p "$skills"
make_skill files '' << 'SH'
id
for folder in /home/ann/pictures /tmp /data /var/tmp; do
  echo "from a skill" > "$folder/of-a-skill" && echo "may write $folder"
done
cat /home/ann/pictures/in.txt
touch /usr/of-a-skill /etc/of-a-skill 2> /dev/null || echo "may not write the system"
grep -E '^(CapEff|CapPrm|CapBnd|NoNewPrivs):' /proc/self/status | tr '\t' ' '
mount -t tmpfs none /mnt 2> /dev/null || echo "may not mount"
SH
make_skill devices '' << 'SH'
[ -r /dev/video0 ] && head -c 1 /dev/video0 > /dev/null 2>&1; [ -w /dev/video0 ] && echo "may use the camera"
(sleep 2; cansend vcan0 123#DEADBEEF) & timeout 20 candump -n 1 vcan0
SH
make_skill drive ', "scheduling": { "policy": "fifo", "priority": 20 }' << 'SH'
chrt -p $$
chrt -f -p 30 $$ 2> /dev/null || echo "may not raise itself"
SH
make_skill ping ', "capabilities": ["NET_RAW"]' << 'SH'
grep -E '^(CapEff|CapBnd|NoNewPrivs):' /proc/self/status | tr '\t' ' '
SH
make_skill guest '' << 'SH'
echo "I am $(id -un) in $(id -nG), at home in $HOME"
echo x > /home/bob/of-a-skill && echo "may write what is bob's"
SH
chown -R roscell: /var/lib/roscell

say "without grants"
configure_node
holds "the node starts" systemctl start roscell
expect "its user" "$(ps -o user= -p "$(systemctl show -P MainPID roscell)")" roscell
expect "its socket" "$(stat -c '%U %G %a' /var/lib/roscell/node.sock)" "roscell roscell 660"
holds "a member of the group asks it" runuser -u ann -- roscell status
! runuser -u bob -- roscell status > /tmp/bob.out 2>&1 || fail "bob may ask it, too"
echo "ok: bob is told: $(head -n 1 /tmp/bob.out)"
run_task files files
for words in "uid=" "may write /home/ann/pictures" "may write /tmp" "may write /data" \
  "may write /var/tmp" "hello" "may not write the system" "CapEff: 0000000000000000" \
  "NoNewPrivs: 1" "may not mount" "the end of the script"; do
  until_holds "the log says '$words'" says_in_log files "$words"
done
run_task devices devices
until_holds "cameras" says_in_log devices "may use the camera"
until_holds "AF_CAN" says_in_log devices "DE AD BE EF"
for skill in drive ping; do
  request "$skill" "$skill" > "/tmp/$skill.json"
  ! roscell run "/tmp/$skill.json" > "/tmp/$skill.out" 2>&1 || fail "$skill runs without a grant"
  grep -o "skill '$skill' wants.*" "/tmp/$skill.out" | head -n 1 || fail "$(cat "/tmp/$skill.out")"
done

say "grants of what the node may not do"
for grant in ping=capability:NET_RAW drive=scheduling:fifo:20 guest=user:bob \
  ping=user:nobody-at-all ping=capability:FLY; do
  configure_node "grant = $grant"
  systemctl restart roscell 2> /dev/null && fail "it starts with $grant"
  systemctl stop roscell
  journalctl -q --no-pager -o cat -u roscell -n 40 | grep -E -m 1 -- '--grant|node.conf:' \
    || fail "it does not say why"
done

say "grants of what the unit gives it"
mkdir -p /etc/systemd/system/roscell.service.d
cat > /etc/systemd/system/roscell.service.d/grants.conf << 'CONF'
[Service]
CapabilityBoundingSet=CAP_NET_RAW CAP_SETUID CAP_SETGID CAP_KILL
AmbientCapabilities=CAP_NET_RAW CAP_SETUID CAP_SETGID CAP_KILL
LimitRTPRIO=20
CONF
systemctl daemon-reload
configure_node 'grant = ping=capability:NET_RAW' 'grant = drive=scheduling:fifo:20' \
  'grant = guest=user:bob'
holds "the node starts" systemctl start roscell
run_task ping ping
until_holds "the capability" says_in_log ping "CapEff: 0000000000002000"
run_task drive drive
until_holds "real time" says_in_log drive "SCHED_FIFO"
until_holds "no more of it" says_in_log drive "may not raise itself"
run_task guest guest
until_holds "another user" says_in_log guest "I am bob in bob"
until_holds "his files" says_in_log guest "may write what is bob's"
until_holds "the others go on" says_in_log files "the end of the script"
for task in ping drive guest files devices; do
  holds "task $task is stopped" roscell stop "$task"
done
expect "processes that are left" "$(pgrep -u roscell,bob -c -f bin/run)" 0
systemd-analyze security --no-pager roscell.service | tail -n 1
