#include "actors/edge/host/instance_use.hpp"
#include "host_probe_fixture.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr const char* container =
    "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

/// A host with a hierarchy of version 2 in its folder.
struct fake_host : fixture_root {
  fake_host() {
    write("/proc/self/mountinfo",
          "30 23 0:26 / " + path() + "/cgroup rw - cgroup2 cgroup2 rw\n");
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
