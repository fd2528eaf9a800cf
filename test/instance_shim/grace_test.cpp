#include "test/instance_shim/shim_run.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

/// A program that takes its time to end, says when it is told that somebody
/// waits for it to be stop-safe, and that it has ended.
constexpr const char* careful = R"(
exec bash -c 'trap "sleep 0.3; echo parked; exit 0" TERM
  trap "echo asked" USR1
  echo up
  while :; do sleep 0.05; done')";

/// A shell in front of it that passes nothing on and dies of SIGTERM.
std::string wrapped(const std::string& before = {}) {
  return before + "sh -c '" + std::string{"sleep 0; "}
         + R"(bash -c "trap \"sleep 0.3; echo parked; exit 0\" TERM
  trap \"echo asked\" USR1
  echo up
  while :; do sleep 0.05; done"; echo after')";
}

} // namespace

TEST_CASE("what a wrapper has started gets the grace that is its own",
          "[grace]") {
  // In the wrapper's process group, or in one of its own.
  const auto script = GENERATE(wrapped(), wrapped("setsid "));
  shim_run run{script};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  run.process.signal(SIGTERM);
  CHECK(run.process.wait() == 0);
  CHECK_THAT(run.log(0), Contains("parked"));
  CHECK(run.exit()["terminated"] == true);
}

TEST_CASE("the grace of what a wrapper has left ends by SIGQUIT", "[grace]") {
  shim_run run{"sh -c 'trap \"\" TERM; echo up; sleep 1000' & wait"};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  run.process.signal(SIGTERM);
  CHECK(wait_for_end(static_cast<pid_t>(run.pids()[2])));
  CHECK(run.exit().is_discarded());
  run.process.signal(SIGQUIT);
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["signal"] == SIGTERM);
}

TEST_CASE("a command that ends by itself leaves nobody time", "[grace]") {
  shim_run run{"sh -c 'trap \"\" TERM; sleep 1000' & echo $!; exit 3"};
  CHECK(run.process.wait() == 0);
  CHECK(run.exit()["code"] == 3);
  CHECK(wait_for_end(std::stoi(run.log(0))));
}

TEST_CASE("SIGUSR1 reaches the program that takes it, behind any wrapper",
          "[grace]") {
  const auto script = GENERATE(std::string{careful}, wrapped());
  shim_run run{script};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  run.process.signal(SIGUSR1);
  CHECK(run.wait_for_log("asked"));
  run.process.signal(SIGTERM);
  CHECK(run.process.wait() == 0);
  CHECK_THAT(run.log(0), Contains("parked"));
}

TEST_CASE("SIGUSR1 ends nobody who does not take it, and that is said",
          "[grace]") {
  shim_run run{"echo up; sh -c 'sleep 1000'; echo after"};
  REQUIRE((run.wait_for("pid") && run.wait_for_log("up")));
  run.process.signal(SIGUSR1);
  REQUIRE(run.wait_for_log("nobody here takes SIGUSR1"));
  CHECK(run.exit().is_discarded());
  run.process.signal(SIGTERM);
  CHECK(run.process.wait() == 0);
}
