# The cell that the dashboard is tried with: a coordinator and three members, a
# second cell, a node in no cell, and a task of cameras and pose estimators where
# those are built. Needs test/system/lib.sh.

# make_talker: the skill `talk`, a program that says a line whenever one is added
# to the file that it reads, and one at its start.
make_talker() {
  mkdir -p "$skills/talk/bin"
  cat > "$skills/talk/bin/talk" << 'PROGRAM'
#!/usr/bin/env python3
import json, os, signal, socket, subprocess, sys

words = json.loads(os.environ['ROSCELL_PARAMETERS'])
source = json.loads(os.environ['ROSCELL_INPUTS'])[0]['endpoint']
mouth = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
tail = subprocess.Popen(['tail', '-n', '0', '-F', source], text=True,
                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

def say(text):
    try:
        mouth.sendto(text.encode(), os.environ['NOTIFY_SOCKET'])
    except OSError:
        pass  # A node that starts again has no ear for a while.

def end(*_):
    tail.kill()
    sys.exit(0)

def beat(*_):
    say('READY=1\nWATCHDOG=1')

signal.signal(signal.SIGTERM, end)
signal.signal(signal.SIGALRM, beat)
signal.setitimer(signal.ITIMER_REAL, 2, 2)
beat()
print(words['greeting'], flush=True)
for number, line in enumerate(tail.stdout, 1):
    text = line.rstrip('\n')
    print(text.upper() if words['loud'] else text, flush=True)
    say(f'STATUS=frames={number} dropped=0 median_us=100')
PROGRAM
  chmod +x "$skills/talk/bin/talk"
  jq -n '
    def model($name; $memory_mib): {name: $name, parameters: {
        greeting: {type: "string", default: "hello", description: "Said at the start."},
        loud: {type: "boolean", default: false, description: "In capital letters."},
        patience_s: {type: "number", default: 1, minimum: 0, maximum: 60, unit: "s",
                     description: "Has no effect."}},
      deployments: [{name: "only", base_image: "debian:bookworm-slim", architectures: ["amd64", "arm64"],
        resources: {cpu: 0, memory_mib: $memory_mib, disk_mib: 1}}]};
    {operation: "talk", engine: "primitive", entry_point: ["bin/talk"],
    input: {data_types: ["text/plain"], protocols: ["file"]},
    output: {data_types: ["text/plain"], protocols: ["file"]},
    models: [model("plain"; 0), model("wide"; 1500), model("large"; 500000)]}' \
    > "$skills/talk/skill.json"
}

# pose_task: a camera and a pose estimator for each of two rendered scenes.
pose_task() {
  jq -n --arg dir "$scratch" '
    def ros2($n; $topic; $type): {protocol: "ros2",
      endpoint: "/scene_\($n)/\($topic)", data_type: "sensor_msgs/msg/\($type)"};
    def both($n): [ros2($n; "image"; "Image"), ros2($n; "camera_info"; "CameraInfo")];
    {type: "task_request", task: "fleet-poses", pipeline: [
      [1, "left", "rack"], [2, "belt", "belt"] | . as [$n, $camera, $poses]
      | {id: "camera_\($n)", operation: "image_source", model: "folder",
         labels: {place: $camera}, parameters: {rate_hz: 2}, output: both($n),
         input: {protocol: "file", endpoint: "\($dir)/scenes/scene_\($n)", data_type: "image/png"}},
        {id: "poses_\($n)", operation: "pose_estimation", model: "apriltag3",
         labels: {place: $poses}, parameters: {tag_size_m: 0.16, decimation: 4}, input: both($n),
         output: [{protocol: "ros2", endpoint: "/scene_\($n)/tf", data_type: "tf2_msgs/msg/TFMessage"},
                  {protocol: "file", endpoint: "\($dir)/scene_\($n).jsonl", data_type: "application/json"}]}]}'
}

# start_member NAME PLACE CAPACITY [OPTION...]
start_member() {
  local name=$1 place=$2 capacity=$3
  shift 3
  start_node "$name" --interface lo --cpu-floor 0.5 --label "place=$place" \
    --capacity "$capacity" "$@"
}

# start_scene: starts all of it and writes what a test must know to
# $scratch/scene.json.
start_scene() {
  local name server
  skills=$scratch/skills
  mkdir -p "$skills" "$scratch/data"
  make_talker
  touch "$scratch/data/talk.in"
  for name in image_source pose_estimation; do
    [[ ! -d $ROSCELL_BUILD/skills/$name ]] || cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
  done
  start_member head rack cpu=2,memory_mib=4096,disk_mib=8000 --coordinator --cell hall
  server=$(discovery_of head)
  start_member arm-1 left cpu=1.5,memory_mib=2048,disk_mib=4000 --label gripper=soft --join "$server"
  start_member arm-2 right cpu=1,memory_mib=1024,disk_mib=4000 --join "$server"
  start_member edge-3 belt cpu=2,memory_mib=3072,disk_mib=6000 --join "$server"
  start_member spare none cpu=1,memory_mib=1024,disk_mib=4000 --wait
  start_member lab-head none cpu=1,memory_mib=1024,disk_mib=4000 --coordinator --cell lab
  for name in arm-1 arm-2 edge-3; do
    await_joined head "$name"
  done
  if [[ -d $skills/pose_estimation && -x $ROSCELL_BUILD/bin/render_scenes ]]; then
    "$ROSCELL_BUILD/bin/render_scenes" "$scratch/scenes"
    pose_task | to head request > "$scratch/poses.json" || fail "$(cat "$scratch/poses.json")"
  fi
  jq -n --arg socket "$scratch/head/node.sock" --arg dir "$scratch/data" \
    --argjson head "${pid[head]}" --argjson victim "${pid[arm-2]}" \
    '{socket: $socket, data: $dir, coordinator: {name: "head", pid: $head},
      victim: {name: "arm-2", pid: $victim}}' > "$scratch/scene.json"
}
