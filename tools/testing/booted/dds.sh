# Programs of ROS 2 of one user beside skills of another, under the hardened unit.
# Files: scene.sh, the packages, `stock_program` (test/system/hosts, without
# sanitizers), and in pictures/ what render_scenes has made.
. ./scene.sh

install_packages ./*.deb
adduser --quiet --disabled-password --gecos '' ann
adduser --quiet ann roscell
install -m 0755 stock_program /usr/local/bin/stock_program
mkdir -p /data/pictures
cp pictures/*.png pictures/camera.json /data/pictures
chmod -R a+rX /data
configure_node
holds "the node starts" systemctl start roscell
cat > /tmp/see.json << 'JSON'
{ "type": "task_request", "task": "see", "pipeline": [
  { "id": "pictures", "operation": "image_source", "model": "folder", "parameters": { "rate_hz": 5 },
    "input": { "protocol": "file", "endpoint": "/data/pictures", "data_type": "image/png" },
    "output": { "protocol": "ros2", "endpoint": "/camera/image", "data_type": "sensor_msgs/msg/Image" } } ] }
JSON
until_holds "pictures of a skill" roscell run /tmp/see.json
ps -o user=,args= -C image_source

# beside NAME: passes them on as ann, by what the cell tells her.
beside() {
  runuser -u ann -- bash -c 'eval "$(roscell env)"; exec /usr/local/bin/stock_program \
    sensor_msgs/msg/Image --ros-args -r in:=/camera/image -r out:='"$1" \
    > /tmp/stock.out 2>&1 &
}

# comes TOPIC: something does.
comes() {
  timeout 20 roscell hz "$1" > /tmp/hz.out 2>&1
  grep -E '[1-9]' /tmp/hz.out | tail -n 1 | grep .
}

beside /seen
sleep 5
comes /camera/image || head -n 5 /tmp/hz.out
comes /seen || head -n 5 /tmp/hz.out /tmp/stock.out
runuser -u ann -- roscell env
roscell topics
cat /tmp/holds.out
ls -la /dev/shm | grep -v sem | head -n 12
roscell doctor --only leftovers || true

say "a stock program of the node's beside one of ann's"
mkdir -p "$skills/pass"
cat > "$skills/pass/skill.json" << 'JSON'
{ "operation": "pass", "engine": "ros2_standalone",
  "ros2": { "executable": "/usr/local/bin/stock_program",
    "arguments": ["sensor_msgs/msg/Image"], "topics": { "in": "input", "out": "output" } },
  "input": { "data_types": ["sensor_msgs/msg/Image"], "protocols": ["ros2"] },
  "output": { "data_types": ["sensor_msgs/msg/Image"], "protocols": ["ros2"] },
  "models": [ { "name": "plain", "deployments": [ { "name": "cpu", "base_image": "debian:bookworm-slim",
    "architectures": ["amd64"], "resources": { "cpu": 0.1, "memory_mib": 256, "disk_mib": 1 } } ] } ] }
JSON
chown -R roscell: /var/lib/roscell
for user in roscell ann; do
  say "the step is $user's"
  roscell stop passed > /dev/null 2>&1 || true
  mkdir -p /etc/systemd/system/roscell.service.d
  printf '%s\n' '[Service]' 'CapabilityBoundingSet=CAP_SETUID CAP_SETGID CAP_KILL' \
    'AmbientCapabilities=CAP_SETUID CAP_SETGID CAP_KILL' > /etc/systemd/system/roscell.service.d/grants.conf
  systemctl daemon-reload
  configure_node "grant = pass=user:$user"
  holds "the node starts again" systemctl restart roscell
  cat > /tmp/pass.json << 'JSON'
{ "type": "task_request", "task": "passed", "pipeline": [
  { "id": "on", "operation": "pass", "model": "plain", "input": { "protocol": "ros2", "endpoint": "/seen", "data_type": "sensor_msgs/msg/Image" },
    "output": { "protocol": "ros2", "endpoint": "/passed", "data_type": "sensor_msgs/msg/Image" } } ] }
JSON
  until_holds "it runs" roscell run /tmp/pass.json
  ps -o user=,args= -C stock_program
  if comes /passed; then echo "ok: data arrive"; else
    echo "no data arrive"
    roscell doctor --only leftovers || true
  fi
done
