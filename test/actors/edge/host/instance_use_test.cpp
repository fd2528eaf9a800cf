#include "actors/edge/host/instance_use.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

void add_process(temp_folder& root, int pid, int session,
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
  temp_folder root;
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
  temp_folder root;
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
  temp_folder root;
  add_process(root, 100, 100, "a) S 1 1 999 (b", 1, 10);
  CHECK(usage_of({{100}, {}}, root.path()).processes == 1);
  CHECK(usage_of({{999}, {}}, root.path()).processes == 0);
}

TEST_CASE("a process that ends during the scan is left out", "[host_probe]") {
  temp_folder root;
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

namespace {

constexpr const char* container =
    "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

/// A host with a hierarchy of version 2 in its folder.
struct fake_host : temp_folder {
  fake_host() {
    write("/proc/self/mountinfo", "30 23 0:26 / " + path().string()
                                      + "/cgroup rw - cgroup2 cgroup2 rw\n");
  }

  void put(const std::string& cgroup, const std::string& mib) {
    write("/cgroup" + cgroup + "/memory.current", mib + "000000\n");
    write("/cgroup" + cgroup + "/cpu.stat", "usage_usec 1500000\n");
  }
};

} // namespace

TEST_CASE("an instance's use is that of its own cgroup", "[host_probe]") {
  fake_host host;
  // The first child of the shim has moved elsewhere.
  host.write("/proc/10/task/10/children", "11 12 ");
  host.write("/proc/11/cgroup", "0::/elsewhere\n");
  host.write("/proc/12/cgroup", "0::/roscell/node-u/i/deeper\n");
  host.put("/roscell/node-u/i", "1048");
  const auto found = uses_of({{"i", "10:1"}}, host.path());
  REQUIRE(found.size() == 1);
  CHECK(found[0].instance == "i");
  CHECK(found[0].use.memory_mib == Approx(1048e6 / 1048576));
  CHECK(found[0].use.cpu_s == 1.5);
}

TEST_CASE("a container's use is that of the cgroup that its engine made",
          "[host_probe]") {
  fake_host host;
  const std::string id = container;
  host.write("/proc/20/cgroup", "0::/user.slice\n");
  host.write("/proc/21/cgroup",
             "0::/machine.slice/libpod-" + id + ".scope/container\n");
  host.put("/machine.slice/libpod-" + id + ".scope", "20");
  const auto found =
      uses_of({{"i", id}, {"j", std::string(64, 'f')}}, host.path());
  REQUIRE(found.size() == 1);
  CHECK(found[0].instance == "i");
  CHECK(found[0].use.memory_mib == Approx(20e6 / 1048576));
}

TEST_CASE("without a cgroup it is the use of the instance's session",
          "[host_probe]") {
  fake_host host;
  host.write("/proc/10/stat",
             "10 (shim) S 1 10 10 0 -1 0 1 2 3 4 100 100 0 0 20 0 1 0 1 1 "
             "1024 1\n");
  const auto found = uses_of({{"i", "10:1"}}, host.path());
  REQUIRE(found.size() == 1);
  CHECK(found[0].use.memory_mib > 0);
  CHECK(found[0].use.cpu_s > 0);
  CHECK(found[0].use.memory_limit_mib < 0);
  CHECK(uses_of({{"i", "99:1"}, {"j", "not an id"}}, host.path()).empty());
}
