#include "test/actors/fakes/cell_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;

/// A cell that gives its member a place for a discovery server.
struct programs_test : cell_fixture {
  programs_test() {
    site.base.cell_uuid = "c-1";
    site.base.discovery = {{254, 7, "10.0.0.1:11811", 0}};
  }
};

} // namespace

TEST_CASE_METHOD(programs_test, "a member runs the discovery server that its "
                                "cell gives it a place for") {
  form_cell();
  REQUIRE(node.served);
  CHECK(node.served->place == site.base.discovery.front());
  CHECK(node.served->remote_is_there);
  CHECK(node.environment.at("ROS_DOMAIN_ID") == "7");
  CHECK(node.environment.at("ROS_DISCOVERY_SERVER")
        == std::string(254, ';') + "10.0.0.9:11811");
  CHECK(site.status(node).environment == node.environment);
  // The coordinator's server is heard by the own one.
  CHECK_FALSE(node.searching);
}

TEST_CASE_METHOD(programs_test, "a member that comes back tells which server "
                                "it has") {
  form_cell();
  cut(*node.link);
  site.pass(30s);
  REQUIRE(site.status(node).state == node_state::member);
  const auto& reported = site.base.rows.at("arm-1").registration;
  CHECK(reported.server_id == 254);
  CHECK(reported.server_cell == "c-1");
}

TEST_CASE_METHOD(programs_test, "an orphan's programs keep their server") {
  form_cell();
  const auto environment = node.environment;
  site.kill_coordinator();
  cut(*node.link);
  site.pass(60s);
  REQUIRE(site.status(node).state == node_state::orphaned);
  REQUIRE(node.served);
  // Fast DDS would ask the dead coordinator's server 44 times a second.
  CHECK_FALSE(node.served->remote_is_there);
  CHECK(node.environment == environment);
}

TEST_CASE_METHOD(programs_test, "a node that leaves its cell ends its server "
                                "and takes the environment back") {
  form_cell();
  REQUIRE(time.ask<node_departed>(node.membership, leave_cell{"bye"}));
  site.pass(100ms);
  CHECK_FALSE(node.served);
  CHECK(node.environment.empty());
  CHECK(site.status(node).environment.empty());
}

TEST_CASE_METHOD(cell_fixture, "a member of a cell without places runs no "
                               "server of its own") {
  form_cell();
  CHECK_FALSE(node.served);
  CHECK(node.environment.empty());
  // What was interrupted waits for the word at the start, and what was started
  // at another address for that of the registration.
  CHECK(node.environments == 2);
}

TEST_CASE_METHOD(programs_test, "a member that cannot run its own server tells "
                                "its instances that there is none") {
  node.serving_refusal = failure{error_code::unreachable, "no port", "", ""};
  form_cell();
  CHECK(node.environment.empty());
  CHECK(node.environments == 2);
}
