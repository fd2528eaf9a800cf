#include "tools/roscell/doctor/host/memory_sharing.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

dds_program program(int pid, uint32_t user = 1000) {
  return {pid, "talker", user, "net:[1]", "00:1b", false, {0}};
}

/// What is said of these on a host whose memory is 00:1b.
findings said_of(const std::vector<dds_program>& all, size_t closed = 0) {
  return judge_memory_sharing({all, closed}, "00:1b");
}

} // namespace

TEST_CASE("programs of one user and one memory share it", "[doctor]") {
  CHECK(said_of({program(1), program(2)})[0].how == judgement::ok);
  CHECK(said_of({})[0].how == judgement::ok);
  const auto few = said_of({program(1)}, 4);
  CHECK(few[0].how == judgement::skipped);
  CHECK_THAT(few[0].seen, Contains("may not look at: 4"));
}

TEST_CASE("a program with another memory is told with what it lacks",
          "[doctor]") {
  auto apart = program(1);
  apart.memory = "00:1a";
  const auto said = said_of({apart, program(2), program(3)}, 4);
  REQUIRE(said.size() == 1);
  CHECK(said[0].how == judgement::broken);
  CHECK(said[0].seen
        == "domain 0: talker (pid 1, user 1000) has another /dev/shm than "
           "talker (pid 2, user 1000) and 1 more");
  CHECK_THAT(said[0].remedy, Contains("--ipc=host --user 1000"));
  apart.network = "net:[2]";
  CHECK(said_of({apart, program(2)})[0].how == judgement::ok);
  apart = program(1);
  apart.memory = "00:1a";
  apart.domains = {1};
  CHECK(said_of({apart, program(2)})[0].how == judgement::ok);
}

TEST_CASE("programs of other users share only what is open to all",
          "[doctor]") {
  const auto said = said_of({program(1, 0), program(2), program(3)});
  REQUIRE(said.size() == 1);
  CHECK(said[0].how == judgement::broken);
  CHECK_THAT(said[0].seen, Contains("talker (pid 1, user 0) may not share"));
  CHECK_THAT(said[0].remedy, Contains("sudo -u '#1000'"));
  auto first = program(1, 0);
  auto second = program(2);
  first.open_to_all = second.open_to_all = true;
  CHECK(said_of({first, second})[0].how == judgement::ok);
}
