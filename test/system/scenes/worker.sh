# A skill whose program does as it is told, with its starts written down. Shared
# by the system tests and tools/bench/lives_bench.sh.

# make_worker: the skill `work`, a program that obeys the file $scratch/orders:
# `crash STEP` (once), `done STEP`, `safe STEP`. It writes down when it starts, by the
# clock of the boot, which all nodes of a test share.
make_worker() {
  skills=$scratch/skills
  mkdir -p "$skills/work/bin" "$scratch/orders"
  cat > "$skills/work/bin/work" << 'PROGRAM'
#!/usr/bin/env python3
import ctypes, ctypes.util, json, os, select, signal, socket, sys, time

home = json.loads(os.environ['ROSCELL_PARAMETERS'])['orders']
step = os.environ['ROSCELL_STEP']
careful = json.loads(os.environ['ROSCELL_PARAMETERS'])['careful']
wanted = []
signal.signal(signal.SIGUSR1, lambda *x: wanted.append(1))
signal.signal(signal.SIGTERM, lambda *x: sys.exit(0))
mouth = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)

def say(text):
    try:
        mouth.sendto(text.encode(), os.environ['NOTIFY_SOCKET'])
    except OSError:
        pass  # A node that starts again has no ear for a while.

with open(f'{home}/starts', 'a') as starts:
    starts.write(f"{time.clock_gettime(time.CLOCK_BOOTTIME)} {step} "
                 f"{os.environ['ROSCELL_INSTANCE']} {os.getpid()}\n")
print(f'{step} works', flush=True)
libc = ctypes.CDLL(None)
watch = libc.inotify_init()
libc.inotify_add_watch(watch, home.encode(), 0x180)
if careful:
    say('ROSCELL_SAFE=0')
while True:
    say('READY=1\nWATCHDOG=1' + ('' if careful else '\nROSCELL_SAFE=1'))
    if wanted and careful and os.path.exists(f'{home}/safe.{step}'):
        say('ROSCELL_SAFE=1')
    if os.path.exists(f'{home}/done.{step}'):
        sys.exit(0)
    if os.path.exists(f'{home}/crash.{step}'):
        os.unlink(f'{home}/crash.{step}')
        print(f'{step} crashes', flush=True)
        sys.exit(7)
    try:
        if select.select([watch], [], [], 3)[0]:
            os.read(watch, 4096)
    except InterruptedError:
        pass
PROGRAM
  chmod +x "$skills/work/bin/work"
  jq -n '{operation: "work", engine: "primitive", entry_point: ["bin/work"],
    safe_state: true,
    input: {data_types: ["text/plain"], protocols: ["file"]},
    output: {data_types: ["text/plain"], protocols: ["file"]},
    models: [{name: "plain", parameters: {orders: "", careful: false},
      deployments: [{name: "any", base_image: "debian:bookworm-slim",
        architectures: ["amd64", "arm64"],
        resources: {cpu: 0, memory_mib: 0, disk_mib: 1}}]}]}' \
    > "$skills/work/skill.json"
}

# forget_safety: the same program as a skill that may be ended at any time.
forget_safety() {
  local text
  text=$(jq 'del(.safe_state)' "$skills/work/skill.json")
  echo "$text" > "$skills/work/skill.json"
}

# work_task TASK STEP-JSON...: a task of these steps, each with what it adds.
work_task() {
  local task=$1
  shift
  jq -n --arg task "$task" --arg orders "$scratch/orders" '
    {type: "task_request", task: $task,
     pipeline: [$ARGS.positional[] | fromjson
       | {operation: "work", model: "plain"} + .
       | .parameters = {orders: $orders} + (.parameters // {})]}' \
    --args "$@"
}

order() {
  touch "$scratch/orders/$1.$2"
}

# watch_end STEP: writes down when the program that a step has now ends, by the
# clock of the boot.
watch_end() {
  local number
  number=$(awk -v s="$1" '$2 == s { n = $4 } END { print n }' "$scratch/orders/starts")
  python3 - "$number" > "$scratch/end.$1" << 'WATCH' &
import os, select, sys, time
fd = os.pidfd_open(int(sys.argv[1]))
select.select([fd], [], [])
print(time.clock_gettime(time.CLOCK_BOOTTIME), flush=True)
WATCH
  echo $! >> "$scratch/pids"
}

# last_start STEP: when it was started last, by the same clock.
last_start() {
  awk -v s="$1" '$2 == s { t = $1 } END { print t }' "$scratch/orders/starts"
}
