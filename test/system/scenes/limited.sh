# A skill that takes what it is told to take of its host.

# make_limited: the skill `limited`, which may use 64 MiB: a program that obeys the
# file $scratch/orders/ORDER: `eat` takes memory without end, `hold` keeps 40 MiB,
# `bomb` starts programs that start others, in sessions of their own, and listens to
# nobody. What it has done is told by the pipe $scratch/orders/said.
make_limited() {
  skills=$scratch/skills
  mkdir -p "$skills/limited/bin" "$scratch/orders"
  cat > "$skills/limited/bin/limited" << 'PROGRAM'
#!/usr/bin/env python3
import ctypes, json, os, select, signal, socket, subprocess, sys

home = json.loads(os.environ['ROSCELL_PARAMETERS'])['orders']
mouth = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
held = []

def say(text):
    try:
        mouth.sendto(text.encode(), os.environ['NOTIFY_SOCKET'])
    except OSError:
        pass  # A node that starts again has no ear for a while.

def tell(word):
    with open(f'{home}/said', 'w') as said:
        said.write(word + '\n')

def bomb():
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    for _ in range(20):
        subprocess.Popen(['setsid', 'sh', '-c', "trap '' TERM; while :; do sleep 1000 & sleep 0.2; done"])
    # Where it may, one leaves the cgroup.
    subprocess.Popen(['setsid', 'sh', '-c', '''trap '' TERM
        for x in /sys/fs/cgroup/cgroup.procs /sys/fs/cgroup/*/cgroup.procs; do echo $$ > $x; done 2> /dev/null
        while :; do sleep 1000; done'''])
    tell('bombed')

libc = ctypes.CDLL(None)
watch = libc.inotify_init()
libc.inotify_add_watch(watch, home.encode(), 0x180)
while True:
    say('READY=1\nWATCHDOG=1')
    if os.path.exists(f'{home}/eat'):
        os.unlink(f'{home}/eat')
        while True:
            held.append(b'x' * 2**20)
    if os.path.exists(f'{home}/hold') and not held:
        held.append(b'x' * 40 * 2**20)
        tell('held')
    if os.path.exists(f'{home}/bomb'):
        os.unlink(f'{home}/bomb')
        bomb()
    try:
        if select.select([watch], [], [], 3)[0]:
            os.read(watch, 4096)
    except InterruptedError:
        pass
PROGRAM
  chmod +x "$skills/limited/bin/limited"
  rm -f "$scratch/orders/said"
  mkfifo "$scratch/orders/said"
  describe_limited limited bin/limited
}

# describe_limited NAME PROGRAM: its skill.json.
describe_limited() {
  jq -n --arg name "$1" --arg program "$2" '{operation: $name,
    engine: "primitive", entry_point: [$program],
    input: {data_types: ["text/plain"], protocols: ["file"]},
    output: {data_types: ["text/plain"], protocols: ["file"]},
    models: [{name: "plain", parameters: {orders: ""},
      deployments: [{name: "any", base_image: "debian:bookworm-slim",
        architectures: ["amd64", "arm64"],
        resources: {cpu: 0.1, memory_mib: 64, disk_mib: 1}}]}]}' \
    > "$skills/$1/skill.json"
}

# make_hungry: the skill `hungry`, which eats until it is ended; where nothing bounds
# it, it ends by itself before its host does.
make_hungry() {
  skills=$scratch/skills
  mkdir -p "$skills/hungry/bin"
  printf '#!/bin/sh\nulimit -v 1000000\nexec tail /dev/zero\n' > "$skills/hungry/bin/hungry"
  chmod +x "$skills/hungry/bin/hungry"
  describe_limited hungry bin/hungry
}

# make_later_hungry: the skill `later`, which is ready, waits for a second, and eats
# then; also in a container of Debian's smallest image.
make_later_hungry() {
  skills=$scratch/skills
  mkdir -p "$skills/later/bin"
  cat > "$skills/later/bin/later" << 'PROGRAM'
#!/usr/bin/perl
use Socket;
socket(my $mouth, PF_UNIX, SOCK_DGRAM, 0);
send($mouth, "READY=1\nWATCHDOG=1", 0, sockaddr_un($ENV{NOTIFY_SOCKET}));
select(undef, undef, undef, 1);
my @held;
push @held, 'x' x (1048576 + $_) for 1 .. 1000;
PROGRAM
  chmod +x "$skills/later/bin/later"
  describe_limited later bin/later
}

# limited_task TASK [OPERATION]: a task of it that is not started again.
limited_task() {
  jq -n --arg task "$1" --arg orders "$scratch/orders" --arg name "${2:-limited}" '
    {type: "task_request", task: $task, pipeline: [{id: "a", operation: $name,
      model: "plain", parameters: {orders: $orders},
      restart: {policy: "never"}}]}'
}

# await_word WORD: until the program has said so.
await_word() {
  local said=
  read -r -t "$deadline_s" said <> "$scratch/orders/said"
  expect "its word" "$said" "$1"
}
