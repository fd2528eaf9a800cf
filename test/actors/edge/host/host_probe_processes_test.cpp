#include "actors/edge/host/host_probe_processes.hpp"
#include "host_probe_fixture.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

using namespace roscell;
using namespace roscell::test;

namespace {

void add_process(fixture_root& root, int pid, int session,
                 const std::string& name, long long seconds, long long mib) {
  auto ticks = std::to_string(seconds * sysconf(_SC_CLK_TCK));
  auto pages = std::to_string(mib * 1024 * 1024 / sysconf(_SC_PAGESIZE));
  auto id = std::to_string(pid);
  // pid (comm) state ppid pgrp session tty tpgid flags minflt cminflt majflt
  // cmajflt utime stime cutime cstime priority nice threads 0 start vsize rss
  root.write("/proc/" + id + "/stat",
             id + " (" + name + ") S 1 " + id + ' ' + std::to_string(session)
                 + " 0 -1 4194304 1 2 3 4 " + ticks + ' ' + ticks
                 + " 0 0 20 0 1 0 12345 1000000 " + pages + " 18446744\n");
}

} // namespace

TEST_CASE("the use of sessions is the sum of their processes' use",
          "[host_probe]") {
  fixture_root root;
  add_process(root, 100, 100, "leader", 1, 10);
  add_process(root, 101, 100, "child", 2, 20);
  add_process(root, 200, 200, "other session", 4, 40);
  add_process(root, 300, 300, "stranger", 8, 80);
  root.write("/proc/meminfo", "not a process");
  auto usage = usage_of({{100, 200}, {}}, root.path());
  CHECK(usage.processes == 3);
  CHECK(usage.cpu_seconds == Approx(14));
  CHECK(usage.rss_mib == Approx(70));
}

TEST_CASE("a container's processes are known by their cgroup", "[host_probe]") {
  const std::string ours(64, 'a');
  const std::string other = std::string(63, 'a') + 'b';
  fixture_root root;
  int pid = 100;
  for (const auto& path :
       {"/docker/" + ours, "/system.slice/docker-" + ours + ".scope",
        "/machine.slice/libpod-" + ours + ".scope/container", "/../" + ours,
        "/docker/" + other + "/docker/" + ours}) {
    ++pid;
    add_process(root, pid, pid, "skill", 1, 10);
    root.write("/proc/" + std::to_string(pid) + "/cgroup",
               "4:memory:/\n0::" + path + '\n');
  }
  add_process(root, 200, 200, "of another container", 1, 10);
  root.write("/proc/200/cgroup", "0::/docker/" + other + '\n');
  add_process(root, 201, 201, "of a longer name", 1, 10);
  root.write("/proc/201/cgroup", "0::/docker/a" + ours + '\n');
  add_process(root, 202, 202, "of none", 1, 10);
  CHECK(usage_of({{}, {ours}}, root.path()).pids
        == std::set<pid_t>{101, 102, 103, 104, 105});
  CHECK(usage_of({{202}, {other}}, root.path()).pids
        == std::set<pid_t>{105, 200, 202});
}

TEST_CASE("a process may be called anything", "[host_probe]") {
  fixture_root root;
  add_process(root, 100, 100, "a) S 1 1 999 (b", 1, 10);
  CHECK(usage_of({{100}, {}}, root.path()).processes == 1);
  CHECK(usage_of({{999}, {}}, root.path()).processes == 0);
}

TEST_CASE("a process that ends during the scan is left out", "[host_probe]") {
  fixture_root root;
  root.write("/proc/100/stat", "");
  root.write("/proc/101/stat", "101 (x) S 1 101");
  root.write("/proc/102/status", "no stat file");
  CHECK(usage_of({{100, 101, 102}, {}}, root.path()).processes == 0);
}

TEST_CASE("no sessions use nothing", "[host_probe]") {
  CHECK(usage_of({}).processes == 0);
  CHECK(usage_of({{1}, {}}, "/no/such/root").processes == 0);
}

TEST_CASE("this test's own session uses memory", "[host_probe]") {
  auto usage = usage_of({{getsid(0)}, {}});
  CHECK(usage.processes >= 1);
  CHECK(usage.rss_mib > 0);
}
