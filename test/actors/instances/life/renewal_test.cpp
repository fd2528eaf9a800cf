#include "actors/instances/limits.hpp"
#include "test/actors/fakes/instance_bench.hpp"

#include <map>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// Its program was started at an address that is gone, and can be told so.
struct renewal_bench : instance_bench {
  renewal_bench() {
    config.row.spec.life.restart.policy = restart_when::never;
    config.address = "10.0.0.9";
    config.started_at = "10.0.0.5";
    config.renewal = "the address of this host has changed";
    config.row.spec.environment = {{"ROS_DISCOVERY_SERVER", "10.0.0.5:11811"},
                                   {"ROS_DOMAIN_ID", "3"},
                                   {"SECRET", "x"}};
    config.environment = {{"ROS_DISCOVERY_SERVER", "10.0.0.9:11811"}};
    config.write_environment_update = [this](const std::string& instance,
                                             const auto& variables) {
      CHECK(instance == "i");
      reported_variables.push_back(variables);
      return listens;
    };
  }

  bool listens = true;
  std::vector<std::map<std::string, std::string>> reported_variables;
};

} // namespace

TEST_CASE("what goes on at another address when it is told is not restarted") {
  renewal_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  REQUIRE(b.reported_variables.size() == 1);
  CHECK(
      b.reported_variables[0]
      == std::map<std::string, std::string>{
          {"ROS_DISCOVERY_SERVER", "10.0.0.9:11811"}, {"ROS_DOMAIN_ID", "3"}});
  CHECK(b.runtime->stopped.empty());
  CHECK(b.state() == instance_state::running);
  // A node that is started again does not tell it once more.
  CHECK(json::parse(b.store->records.back().value).at("address") == "10.0.0.9");
  b.advance(limits::instance::watchdog - 1s);
  b.alive();
  b.advance(limits::instance::watchdog - 1s);
  b.alive();
  b.advance(limits::instance::watchdog - 1s);
  b.exits(4);
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE("what does not listen is started again at another address") {
  renewal_bench b;
  b.listens = false;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "the address of this host has changed");
}

TEST_CASE("what fails when it is told of another address is started again") {
  renewal_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  b.exits(4);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "it ended with exit code 4");
  b.advance(1ms);
  REQUIRE(b.runtime->started.size() == 1);
  // Its next end is one as any other.
  b.ready();
  b.exits(4, b.runtime->container());
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE(
    "what ends by itself after it was told of another address has ended") {
  renewal_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  b.exits(0);
  CHECK(b.state() == instance_state::stopped);
}
