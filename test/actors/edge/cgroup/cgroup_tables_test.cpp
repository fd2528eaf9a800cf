#include "actors/edge/cgroup/cgroup_tables.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

namespace {

constexpr const char* unified_mounts =
    "23 1 0:21 / /proc rw - proc proc rw\n"
    "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw\n"
    "90 30 0:26 /roscell.slice/instances /sys/fs/cgroup/roscell.slice/instances"
    " rw - cgroup2 cgroup2 rw\n";

constexpr const char* hybrid_mounts =
    "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
    "32 31 0:29 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n"
    "33 31 0:30 / /sys/fs/cgroup/systemd rw - cgroup cgroup rw,name=systemd\n"
    "34 31 0:31 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup "
    "rw,cpu,cpuacct\n"
    "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
    "36 31 0:33 / /sys/fs/cgroup/a\\040b rw - cgroup cgroup rw,freezer\n";

} // namespace

TEST_CASE("the hierarchies are those that bound an instance", "[cgroup]") {
  const auto unified = cgroup_mounts_in(unified_mounts);
  REQUIRE(unified.size() == 1);
  CHECK(unified[0].unified);
  // Not the part of it that is mounted once more.
  CHECK(unified[0].point == "/sys/fs/cgroup");
  const auto hybrid = cgroup_mounts_in(hybrid_mounts);
  REQUIRE(hybrid.size() == 4);
  CHECK(hybrid[0].unified);
  CHECK(hybrid[1].controllers == std::set<std::string>{"cpu", "cpuacct"});
  CHECK(hybrid[2].controllers == std::set<std::string>{"memory"});
  CHECK(hybrid[3].point == "/sys/fs/cgroup/a b");
}

TEST_CASE("what is no table of mounts gives none", "[cgroup]") {
  for (const std::string text :
       {"", "\n\n", " - ", "1 2 3 4 - cgroup2", "a b c d e - cgroup2 x",
        "1 2 0:3 / /x rw", "1 2 0:3 / /x rw - cgroup cgroup rw,perf_event"})
    CHECK(cgroup_mounts_in(text).empty());
  CHECK(cgroup_mounts_in(std::string(100'000, '\n')).empty());
  CHECK(cgroup_mounts_in(std::string(100'000, ' ')).empty());
}

TEST_CASE("a process is where its lines say", "[cgroup]") {
  const auto all =
      cgroups_in("12:pids:/\n8:memory:/jobs/1\n7:cpu,cpuacct:/jobs\n"
                 "2:perf_event:/\n1:name=systemd:/x\n0::/y:z\n"
                 "broken\n:\n::\n9:freezer:relative\n");
  REQUIRE(all.size() == 4);
  CHECK(all[0].controllers == std::set<std::string>{"pids"});
  CHECK(all[1].path == "/jobs/1");
  CHECK(all[2].controllers == std::set<std::string>{"cpu", "cpuacct"});
  CHECK(all[3].controllers.empty());
  CHECK(all[3].path == "/y:z");
  const auto mounts = cgroup_mounts_in(hybrid_mounts);
  REQUIRE(member_of(mounts[2], all) != nullptr);
  CHECK(member_of(mounts[2], all)->path == "/jobs/1");
  CHECK(member_of(mounts[3], all) == nullptr);
}

TEST_CASE("a cgroup has a folder where it is mounted, and nowhere else",
          "[cgroup]") {
  const cgroup_mount whole{true, {}, "/", "/sys/fs/cgroup"};
  CHECK(folder_of(whole, "/") == "/sys/fs/cgroup");
  CHECK(folder_of(whole, "/a/b") == "/sys/fs/cgroup/a/b");
  CHECK_FALSE(folder_of(whole, "/../b"));
  const cgroup_mount part{true, {}, "/docker/1", "/mnt"};
  CHECK(folder_of(part, "/docker/1") == "/mnt");
  CHECK(folder_of(part, "/docker/1/x") == "/mnt/x");
  CHECK_FALSE(folder_of(part, "/docker/12"));
  CHECK_FALSE(folder_of(part, "/docker"));
}

TEST_CASE("a cgroup is found by a part of its name, whatever is below it",
          "[cgroup]") {
  CHECK(up_to_name("/machine.slice/libpod-abc.scope/container", "abc")
        == "/machine.slice/libpod-abc.scope");
  CHECK(up_to_name("/docker/abc", "abc") == "/docker/abc");
  CHECK_FALSE(up_to_name("/docker/abc", "abd"));
  CHECK_FALSE(up_to_name("/docker/abc", ""));
}

TEST_CASE("numbers in files of the kernel are read, and nothing else",
          "[cgroup]") {
  const auto* events = "low 0\nhigh 0\nmax 17\noom 2\noom_kill 3\n";
  CHECK(value_of(events, "oom") == 2);
  CHECK(value_of(events, "oom_kill") == 3);
  CHECK(value_of(events, "kill") == -1);
  CHECK(value_of("", "oom") == -1);
  CHECK(number_alone("12\n") == 12);
  CHECK(number_alone("max\n") == -1);
  CHECK(number_alone("12 13") == -1);
  CHECK(number_alone("99999999999999999999999") == -1);
  CHECK(number_alone("") == -1);
}
