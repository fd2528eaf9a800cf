#include "test/instance_shim/own_cgroup.hpp"
#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

/// Neither SIGTERM nor the end of its group's leader ends it.
constexpr const char* stubborn = "trap '' TERM; echo up; "
                                 "while :; do sleep 1000; done";

bool is_there(const own_cgroup& x, const std::string& file) {
  if (!x.has(file))
    WARN("SKIPPED: no cgroup with " + file + " can be made here");
  return x.has(file);
}

std::string with_children(const std::string& what) {
  return "for i in $(seq 50); do setsid " + what + " & done; ";
}

} // namespace

TEST_CASE("a command that is out of memory is recorded as such", "[cgroup]") {
  const own_cgroup cgroup;
  if (!is_there(cgroup, "memory.limit_in_bytes"))
    return;
  cgroup.put("memory.limit_in_bytes", "33554432");
  shim_run run{"exec tail /dev/zero", 65536, {}, cgroup.options()};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGKILL);
  CHECK(run.exit()["memory_kills"] > 0);
  CHECK(run.exit()["most_memory_bytes"] > 30'000'000);
  CHECK(run.exit()["most_memory_bytes"] <= 33'554'432);
}

TEST_CASE("a command that somebody kills has not been out of memory",
          "[cgroup]") {
  const own_cgroup cgroup;
  if (!is_there(cgroup, "memory.limit_in_bytes"))
    return;
  shim_run run{"kill -9 $$", 65536, {}, cgroup.options()};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGKILL);
  CHECK(run.exit()["memory_kills"] == 0);
}

TEST_CASE("the shim is not in the cgroup of its command", "[cgroup]") {
  const own_cgroup cgroup;
  if (!is_there(cgroup, "pids.max"))
    return;
  shim_run run{"echo up; exec sleep 1000", 65536, {}, cgroup.options()};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  CHECK(cgroup.get("cgroup.procs") == std::to_string(run.pids()[2]) + "\n");
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
}

TEST_CASE("all in the cgroup end, whatever session they are in", "[cgroup]") {
  const own_cgroup cgroup;
  if (!is_there(cgroup, "pids.max"))
    return;
  cgroup.put("pids.max", "500");
  // They start others as fast as they can, and listen to nobody.
  shim_run run{"trap '' TERM; "
                   + with_children("sh -c '" + std::string{stubborn} + "'")
                   + "bomb() { bomb | bomb & }; bomb 2>/dev/null; " + stubborn,
               65536,
               {},
               cgroup.options()};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  run.process.signal(SIGTERM);
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
  CHECK(cgroup.get("cgroup.procs").empty());
}

TEST_CASE("who has left the cgroup ends all the same", "[cgroup]") {
  const own_cgroup cgroup;
  if (!is_there(cgroup, "pids.max"))
    return;
  std::string leave;
  for (const auto& x : cgroup.folders)
    leave += "echo $$ > " + x + "/../cgroup.procs; ";
  shim_run run{"setsid sh -c '" + leave
                   + "echo $$; exec sleep 1000' & exec sleep 1000",
               65536,
               {},
               cgroup.options()};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("\n")));
  const auto escaped = std::stoi(run.log(0));
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
  CHECK(wait_for_end(escaped));
}

TEST_CASE("a command whose cgroup is gone says so and runs", "[cgroup]") {
  shim_run run{"echo up", 65536, {}, {"--cgroup", "/sys/fs/cgroup/none/of/it"}};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 0);
  CHECK_THAT(run.log(0), Contains("it runs without limits") && Contains("up"));
}
