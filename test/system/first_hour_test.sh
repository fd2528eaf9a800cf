# What people do in their first hour with a cell, and what it tells them then.

# A program that says what it was given, or ends at once with the code $END.
make_moody() {
  mkdir -p "$skills/moody"
  jq '.operation = "moody" | .entry_point = ["run.py", "own"] | del(.version)' \
    "$skills/echo/skill.json" > "$skills/moody/skill.json"
  cat > "$skills/moody/run.py" << 'EOF'
#!/usr/bin/env python3
import os, signal, socket, sys
print("moody:", *sys.argv[1:], "mood=" + os.environ.get("MOOD", "none"), flush=True)
os.write(1, b"caf\xe9 \xff\n")
if "END" in os.environ:
    print("moody: the calibration is upside down", flush=True)
    sys.exit(int(os.environ["END"]))
node = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
node.connect(os.environ["NOTIFY_SOCKET"])
node.send(b"READY=1")
while not signal.sigtimedwait([signal.SIGTERM], 3):
    node.send(b"WATCHDOG=1")
EOF
  chmod +x "$skills/moody/run.py"
}

start_pair() {
  make_moody
  start_node head --interface lo --coordinator --cell line
  start_node arm --interface lo --join "$(discovery_of head)"
  await_joined head arm
}

# moody_task TASK JQ: a step on the head, changed by a filter.
moody_task() {
  touch "$scratch/in"
  jq -n --arg task "$1" --arg dir "$scratch" '{task: $task, pipeline: [
    {id: "say", operation: "moody", model: "plain", input: ($dir + "/in"),
     output: ($dir + "/" + $task + ".out"), labels: {node: "head"}}]}' \
    | jq ".pipeline[0] |= ($2)"
}

shows() {
  [[ $1 == *"$2"* ]] || fail "'$1' does not show '$2'"
}

test_a_step_says_its_node_its_environment_and_its_arguments() {
  local row
  start_pair
  moody_task t '.env = {MOOD: "good"} | .arguments = ["--loud", "two words"]' \
    > "$scratch/t.json"
  to head check -q "$scratch/t.json" 2> "$scratch/checked" \
    || fail "$(cat "$scratch/checked")"
  to head run "$scratch/t.json" > /dev/null
  row=$(to head instances -o json | jq -c '.[0]')
  expect "node" "$(jq -r .node <<< "$row")" head
  shows "$(to head logs t)" "moody: own --loud two words mood=good"
  moody_task u '.env = {ROS_DOMAIN_ID: "7"}' > "$scratch/u.json"
  to head run "$scratch/u.json" > /dev/null 2> "$scratch/refused" \
    && fail "it can leave its cell"
  shows "$(cat "$scratch/refused")" "does not set itself, got \"ROS_DOMAIN_ID\""
  moody_task u '.labels.node = "nobody"' > "$scratch/u.json"
  to head run "$scratch/u.json" > "$scratch/refused" 2>&1 && fail "on nobody"
  shows "$(cat "$scratch/refused")" "needs the label 'node=nobody'"
}

test_what_a_program_said_before_it_failed_is_shown_by_run() {
  start_pair
  moody_task t '.env = {END: "2"}' > "$scratch/t.json"
  to head run "$scratch/t.json" > /dev/null 2> "$scratch/refused" \
    && fail "it runs"
  shows "$(cat "$scratch/refused")" "  moody: the calibration is upside down"
  grep -q log_tail "$scratch/refused" && fail "it names what it does not show"
  return 0
}

test_a_member_tells_of_what_runs_elsewhere_by_its_coordinator() {
  local id told
  start_pair
  moody_task t . > "$scratch/t.json"
  to arm run "$scratch/t.json" > /dev/null
  id=$(to head instances -o json | jq -r '.[0].name')
  shows "$(to arm logs t)" "moody: own mood=none"
  shows "$(to arm logs "$id")" "moody: own mood=none"
  told=$(to arm describe "$id")
  shows "$told" "Node:           head"
  shows "$(to arm describe task t)" "Kind:           task"
  shows "$(to arm describe node head)" "Role:           coordinator"
  shows "$(to head describe node arm)" "Role:           member"
  # Byte by byte, here and there.
  to head logs t | LC_ALL=C grep -q $'caf\xe9 \xff' || fail "not byte by byte"
  to arm logs t | LC_ALL=C grep -q $'caf\xe9 \xff' || fail "not so at a member"
  to arm logs nobody 2> "$scratch/refused" && fail "nobody has a log"
  shows "$(cat "$scratch/refused")" "no instance and no task 'nobody' is known"
}

test_a_process_is_told_by_its_pid_and_changes_of_it_in_two_lines() {
  local id process
  start_pair
  moody_task t . > "$scratch/t.json"
  to head run "$scratch/t.json" > /dev/null
  id=$(to head instances -o json | jq -r '.[0].name')
  shows "$(to head describe "$id")" "Folder:         $skills/moody"
  process=$(to head describe "$id" | sed -n 's/^Process: *\([0-9]*\),.*/\1/p')
  tr '\0' ' ' < "/proc/$process/cmdline" | grep -q run.py \
    || fail "process '$process' is not its program"
  expect "lines" "$(to head events --since 0 --no-follow \
    | grep -c 'instance_changed')" 2
}

test_check_asks_the_node_of_this_host() {
  start_pair
  need_namespaces
  moody_task t '.operation = "moodi"' > "$scratch/t.json"
  # Where a node of root has its socket, for this command alone.
  ROSCELL_TO='' unshare --mount bash -c 'mount -t tmpfs none /var/lib
    mkdir /var/lib/roscell && ln -s "$1/head/node.sock" /var/lib/roscell
    exec "$2" check "$1/t.json"' - "$scratch" "$ROSCELL" \
    2> "$scratch/refused" && fail "there is no such skill"
  shows "$(cat "$scratch/refused")" "no skill of this cell does 'moodi'"
  ROSCELL_TO='' XDG_STATE_HOME=$scratch/none HOME=$scratch unshare --mount \
    bash -c 'mount -t tmpfs none /var/lib; exec "$2" check "$1/t.json"' - \
    "$scratch" "$ROSCELL" 2> "$scratch/said" || fail "$(cat "$scratch/said")"
  shows "$(cat "$scratch/said")" "no node of this host answers"
}

# start_named NAME FOLDER PORT [OPTION...]: a node that has its name from another
# one. Who waits for it asks others.
start_named() {
  "$ROSCELL" node --name "$1" --data-dir "$scratch/$2" --port "$3" \
    --interface lo --public-domain "$public_domain" --runtime process \
    "${@:4}" 2>> "$scratch/$2.log" &
  echo $! >> "$scratch/pids"
}

test_a_name_that_is_taken_is_told_by_the_coordinator_and_twins_are_not_formed() {
  local port
  start_pair
  start_named arm twin 18470 --join "$(discovery_of head)"
  await head '.event == "node_refused" and .subject == "arm"' > "$scratch/told"
  shows "$(jq -r .data.reason "$scratch/told")" "the name 'arm' belongs to"
  timeout "$deadline_s" "$ROSCELL" node --name '' --interface lo --data-dir "$scratch/none" \
    2> "$scratch/refused" && fail "a name that says nothing is taken"
  shows "$(cat "$scratch/refused")" "the name is empty"
  for port in 18471 18472; do
    start_named free "free$port" "$port" --wait
    await head ".event == \"node_appeared\"
      and .data.address == \"127.0.0.1:$port\"" > /dev/null
  done
  jq -nc '{type: "cell_formation", members: ["free"]}' | to head request \
    > "$scratch/formed"
  shows "$(jq -r '.outcomes[0].message' "$scratch/formed")" \
    "several nodes in no cell are called 'free'"
  to head describe node free 2> "$scratch/refused" && fail "which one?"
  shows "$(cat "$scratch/refused")" "start one of them with another --name"
}

test_a_topic_can_be_measured_as_soon_as_its_task_runs() {
  rm -r "$skills"
  use_skills image_source
  start_node head --interface lo --coordinator --cell line
  jq -n --arg photos "$PWD/test/data/apriltag_photos" '{task: "cam", pipeline: [
    {id: "eye", operation: "image_source", model: "folder",
     input: {protocol: "file", endpoint: $photos, data_type: "image/jpeg"},
     output: {protocol: "ros2", endpoint: "/eye/image",
              data_type: "sensor_msgs/msg/Image"},
     parameters: {rate_hz: 20}}]}' > "$scratch/cam.json"
  to head run "$scratch/cam.json" > /dev/null
  to head hz /eye/image --seconds 4 > "$scratch/measured" 2>&1 \
    || fail "$(cat "$scratch/measured")"
  grep -q ' Hz' "$scratch/measured" || fail "$(cat "$scratch/measured")"
}
