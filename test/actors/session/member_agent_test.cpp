#include "actors/session/limits.hpp"
#include "test/actors/fakes/cell_fakes.hpp"

/// Members with a real membership at the other end of the wire.
namespace {

using namespace roscell;
using namespace roscell::test;

TEST_CASE_METHOD(cell_fixture, "a member is a node agent") {
  form_cell();
  SECTION("for resources") {
    auto reply = time.ask<resource_report>(member(), resource_query{});
    site.pass(1s);
    CHECK((*reply)->value().resources == some_resources("arm-1"));
  }
  SECTION("for reservations") {
    const auto spec = some_spec("t-b-1", "t");
    auto reply = time.ask<instances_reserved>(
        member(), instance_reservation{"t", {spec}});
    site.pass(1s);
    REQUIRE(node.reservations.size() == 1);
    CHECK(node.reservations[0].specs[0] == spec);
    REQUIRE((*reply)->value().refused.size() == 1);
    CHECK((*reply)->value().refused[0].reason == "no room");
  }
  SECTION("for deployments") {
    const auto spec = some_spec("t-a-1", "t");
    auto reply =
        time.ask<instance_deployed>(member(), instance_deployment{spec});
    site.pass(1s);
    CHECK((*reply)->value().instance.spec == spec);
    CHECK((*reply)->value().instance.node == "arm-1");
  }
  SECTION("for removals") {
    auto reply =
        time.ask<instances_removed>(member(), instance_removal{"t", "t-a-1"});
    site.pass(1s);
    CHECK((*reply)->value().instances == std::vector<std::string>{"t-a-1"});
  }
  SECTION("for what its instances say") {
    auto reply = time.ask<figures_report>(member(), figures_query{});
    site.pass(1s);
    REQUIRE((*reply)->value().instances.size() == 1);
    CHECK((*reply)->value().instances[0].metrics.rate_hz == 2.5);
    CHECK((*reply)->value().instances[0].status == "frames=7");
  }
  SECTION("for logs") {
    auto reply = time.ask<log_excerpt>(member(), log_query{"t-a-1"});
    site.pass(1s);
    CHECK((*reply)->value().text == "a line\n");
  }
  SECTION("for kept logs, which are those of the name it has now") {
    auto reply = time.ask<kept_logs>(member(), kept_logs_query{"t-a-1", ""});
    site.pass(1s);
    REQUIRE((*reply)->value().logs.size() == 1);
    CHECK((*reply)->value().logs[0].instance == "t-a-1");
    CHECK((*reply)->value().logs[0].node == "arm-1");
  }
  SECTION("for what only it can tell") {
    std::vector<std::string> asked;
    const auto router =
        time.system.spawn([&](caf::event_based_actor*) -> caf::behavior {
          return {[&](const route_request& x) {
            asked.push_back(x.text + " of " + x.only);
            return request_routed{R"({"type":"cost_report","nodes":[]})", ""};
          }};
        });
    const auto ask = [&](const std::string& text) {
      auto reply = time.ask<request_routed>(member(), route_request{text, ""});
      site.pass(1s);
      return reply;
    };
    const std::string question = R"({"type":"cost_query"})";
    CHECK(to_failure((*ask(question))->error()).message
          == "the node is still starting");
    caf::anon_send(caf::actor_cast<membership_actor>(node.membership),
                   use_router{caf::actor_cast<request_router_actor>(router)});
    CHECK((*ask(question))->value().text
          == R"({"nodes":[],"type":"cost_report"})");
    CHECK(asked == std::vector<std::string>{question + " of cost_query"});
    // What changes something is nobody's to ask of another's node.
    const auto refused = ask(R"({"type":"node_release","node":"arm-1"})");
    CHECK(to_failure((*refused)->error()).code == error_code::unknown_type);
    CHECK(asked.size() == 1);
    time.kill(router);
  }
  SECTION("for errors") {
    auto reply = time.ask<log_excerpt>(member(), log_query{"unknown"});
    site.pass(1s);
    const auto why = to_failure((*reply)->error());
    CHECK(why.code == error_code::unknown_task);
    CHECK(why.where == "/instance");
  }
}

TEST_CASE_METHOD(cell_fixture, "a deployment may take twelve minutes and no "
                               "more") {
  form_cell();
  node.deployment_takes = 717s;
  auto slow = time.ask<instance_deployed>(
      member(), instance_deployment{some_spec("t-a-1", "t")});
  site.pass(718s);
  REQUIRE(*slow);
  CHECK((*slow)->engaged());
  node.deployment_takes = 730s;
  auto never = time.ask<instance_deployed>(
      member(), instance_deployment{some_spec("t-b-1", "t")});
  site.pass(717s);
  CHECK_FALSE(*never);
  site.pass(2s);
  REQUIRE(*never);
  CHECK(to_failure((*never)->error()).code == error_code::timeout);
}

TEST_CASE_METHOD(cell_fixture, "a session cut in the middle of a deployment "
                               "fails it at once") {
  form_cell();
  node.deployment_takes = 10s;
  auto reply = time.ask<instance_deployed>(
      member(), instance_deployment{some_spec("t-a-1", "t")});
  site.pass(1s);
  CHECK(node.deployments.size() == 1);
  cut(*node.link);
  site.pass(0s);
  REQUIRE(*reply);
  CHECK(to_failure((*reply)->error()).code == error_code::unreachable);
  // The answer that comes after the new registration is nobody's.
  site.pass(20s);
  CHECK(state() == node_state::member);
  CHECK(site.base.rows.at("arm-1").active);
}

TEST_CASE_METHOD(cell_fixture, "frames that come twice are done once") {
  site.faults.repeat_frame = 1;
  form_cell();
  CHECK(state() == node_state::member);
  CHECK(site.base.members.size() == 1);
  auto reply = time.ask<instance_deployed>(
      member(), instance_deployment{some_spec("t-a-1", "t")});
  site.pass(1s);
  REQUIRE(*reply);
  CHECK((*reply)->engaged());
  CHECK(node.deployments.size() == 1);
}

TEST_CASE_METHOD(cell_fixture, "a lost request times out and the session goes "
                               "on") {
  form_cell();
  site.faults.drop_frame = 1;
  auto reply = time.ask<resource_report>(member(), resource_query{});
  site.pass(limits::session::resource_query);
  REQUIRE(*reply);
  CHECK(to_failure((*reply)->error()).code == error_code::timeout);
  site.faults.drop_frame = 0;
  auto again = time.ask<resource_report>(member(), resource_query{});
  site.pass(1s);
  CHECK((*again)->engaged());
}

TEST_CASE_METHOD(cell_fixture, "a killed node is lost at once and is the same "
                               "member when it returns") {
  form_cell();
  site.kill(node);
  site.pass(0s);
  CHECK_FALSE(site.base.rows.at("arm-1").active);
  CHECK(site.base.losses.size() == 1);
  site.start(node);
  site.join(node);
  site.pass(1s);
  CHECK(site.base.rows.size() == 1);
  CHECK(site.base.rows.at("arm-1").active);
  CHECK(site.base.rows.at("arm-1").identity.epoch == 2);
}

TEST_CASE_METHOD(cell_fixture,
                 "an hour with 20 % of the heartbeats lost changes "
                 "nothing") {
  site.faults.drop_heartbeat = 0.2;
  site.faults.repeat_heartbeat = 0.1;
  site.faults.longest_delay = 50ms;
  form_cell();
  const auto link = node.link;
  site.pass(3600s);
  CHECK(node.link == link);
  CHECK(state() == node_state::member);
  CHECK(site.base.losses.empty());
}

TEST_CASE_METHOD(cell_fixture, "a member describes itself") {
  form_cell();
  auto reply = time.ask<actor_state>(member(), state_query{});
  site.pass(0s);
  const auto state = json::parse((*reply)->value().json_text);
  CHECK(state["node"] == "arm-1");
  CHECK(state["phase"] == "active");
}

} // namespace
