#include "actors/edge/session/limits.hpp"
#include "test/actors/fakes/cell_fakes.hpp"

namespace {

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;

struct membership_problem_test : cell_fixture {
  /// The last event of that kind.
  json reported(const std::string& what) {
    json result;
    for (const auto& x : site.events)
      if (x.what == what)
        result = x.data;
    return result;
  }

  json request(const std::string& type) {
    auto reply = time.ask<request_routed>(
        node.membership, route_request{json{{"type", type}}.dump(), ""});
    site.pass(100ms);
    REQUIRE(*reply);
    return json::parse((*reply)->value().text);
  }
};

TEST_CASE_METHOD(membership_problem_test,
                 "a node that gets no answer says what is wrong within 5 s") {
  node.probed.discovery = port_answer::closed;
  node.probed.tcp = {{11811, port_answer::closed, {}},
                     {8420, port_answer::closed, {}}};
  site.start(node);
  site.join(node);
  site.pass(1s);
  CHECK(site.count("join_failed") == 0);
  site.pass(3900ms);
  REQUIRE(site.count("join_failed") == 1);
  const auto said = reported("join_failed");
  CHECK(said["discovery_server"] == "10.0.0.1:11811");
  CHECK_THAT(said["reason"].get<std::string>(), Contains("nothing listens"));
  CHECK_THAT(said["hint"].get<std::string>(), Contains("running there"));
  const auto shown = site.status(node).joining;
  REQUIRE(shown.size() == 1);
  CHECK(shown[0].address == "10.0.0.1:11811");
  CHECK(shown[0].problem == said["reason"]);
  CHECK(shown[0].attempts == 1);
}

TEST_CASE_METHOD(membership_problem_test,
                 "each attempt looks again, the log hears of it ever less") {
  site.start(node);
  site.join(node);
  site.pass(2h);
  CHECK(node.looks >= 200);
  CHECK(site.count("join_failed") <= 12);
  CHECK(site.count("join_failed") >= 6);
  CHECK(site.status(node).joining[0].attempts
        == static_cast<int64_t>(node.searches));
}

TEST_CASE_METHOD(membership_problem_test,
                 "who is in a cell shows no attempt to join") {
  site.start(node);
  site.join(node);
  site.pass(3s);
  CHECK(site.status(node).joining.size() == 1);
  site.start_coordinator();
  site.pass(40s);
  CHECK(state() == node_state::member);
  CHECK(site.status(node).joining.empty());
}

TEST_CASE_METHOD(membership_problem_test,
                 "a coordinator that answers at once is not looked at") {
  form_cell();
  site.pass(60s);
  CHECK(node.looks == 0);
  CHECK(site.count("join_failed") == 0);
}

TEST_CASE_METHOD(membership_problem_test,
                 "an orphan says why it cannot return") {
  form_cell();
  site.kill_coordinator();
  site.pass(10s);
  CHECK(state() == node_state::orphaned);
  CHECK(site.count("join_failed") >= 1);
  CHECK(site.status(node).joining.size() == 1);
}

TEST_CASE_METHOD(membership_problem_test,
                 "a refusal is shown, and told again ever less") {
  site.start_coordinator();
  node.refusal = {error_code::unauthorized, "the site tokens differ", "",
                  "copy the file"};
  site.start(node);
  site.join(node);
  site.pass(1s);
  const auto shown = site.status(node).joining;
  REQUIRE(shown.size() == 1);
  CHECK(shown[0].problem == "the site tokens differ");
  CHECK(shown[0].hint == "copy the file");
  site.pass(1h);
  CHECK(site.count("join_refused") >= 4);
  CHECK(site.count("join_refused") <= 8);
}

TEST_CASE_METHOD(membership_problem_test,
                 "a host's name is looked up anew for every attempt") {
  node.names["base.local"] = "10.0.0.1";
  site.start(node);
  caf::anon_send(node.membership, join_cell{"base.local:11811"});
  site.pass(1s);
  CHECK(node.sought == std::vector<std::string>{"10.0.0.1:11811"});
  node.names["base.local"] = "10.0.0.9";
  site.pass(6s);
  CHECK(node.sought.back() == "10.0.0.9:11811");
}

TEST_CASE_METHOD(membership_problem_test,
                 "a name that does not resolve is told, and tried again") {
  site.start(node);
  caf::anon_send(node.membership, join_cell{"base.local:11811"});
  site.pass(1s);
  CHECK_THAT(reported("join_failed")["reason"].get<std::string>(),
             Contains("'base.local' does not resolve"));
  node.names["base.local"] = "10.0.0.1";
  site.start_coordinator();
  site.pass(40s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(membership_problem_test,
                 "a node that wants any place says that it sees nobody") {
  site.start(node);
  caf::anon_send(node.membership, seek_cell{});
  site.pass(4s);
  CHECK_THAT(reported("join_failed")["reason"].get<std::string>(),
             Contains("no coordinator is visible"));
  CHECK(site.status(node).joining[0].address.empty());
  site.pass(2h);
  CHECK(site.count("join_failed") <= 12);
}

TEST_CASE_METHOD(membership_problem_test,
                 "a member has its coordinator answer what it cannot") {
  form_cell();
  CHECK(request("task_query")["type"] == "task_description");
  REQUIRE(site.base.asked.size() == 1);
  CHECK(site.base.asked[0]["type"] == "task_query");
}

TEST_CASE_METHOD(membership_problem_test,
                 "a member's engine gets images by its coordinator") {
  const auto ask = [this] {
    auto reply = time.ask<image_offered>(
        node.membership, image_request{"debian:1", "amd64", "", {}});
    site.pass(1s);
    return *reply;
  };
  form_cell();
  CHECK((*ask())->node == "arm-2");
  REQUIRE(site.base.image_requests.size() == 1);
  CHECK(site.base.image_requests[0].node == node.identity.name);
  site.kill_coordinator();
  site.pass(10s);
  CHECK(to_failure(ask()->error()).code == error_code::unreachable);
}

TEST_CASE_METHOD(membership_problem_test,
                 "a coordinator of an earlier version is asked for no image") {
  site.base.build_key.clear();
  form_cell();
  auto reply = time.ask<image_offered>(
      node.membership, image_request{"debian:1", "amd64", "", {}});
  site.pass(1s);
  CHECK(to_failure((*reply)->error()).code == error_code::conflict);
  CHECK(site.base.image_requests.empty());
}

TEST_CASE_METHOD(membership_problem_test,
                 "a coordinator's refusal reaches the member's user as it is") {
  form_cell();
  site.base.answer = error_reply(
      {error_code::unknown_task, "no such task", "/task", "look at the list"});
  const auto said = request("task_query")["error"];
  CHECK(said["code"] == "unknown_task");
  CHECK(said["message"] == "no such task");
  CHECK(said["hint"] == "look at the list");
}

TEST_CASE_METHOD(membership_problem_test,
                 "what moves nodes is not passed on, but its place is named") {
  form_cell();
  const auto said = request("node_release")["error"];
  CHECK(said["code"] == "unknown_type");
  CHECK_THAT(said["hint"].get<std::string>(), Contains("10.0.0.1:8420"));
  CHECK(site.base.asked.empty());
}

TEST_CASE_METHOD(membership_problem_test,
                 "without its coordinator a node says that it is away") {
  form_cell();
  site.kill_coordinator();
  site.pass(100ms);
  const auto said = request("task_query")["error"];
  CHECK(said["code"] == "unreachable");
  CHECK_THAT(said["message"].get<std::string>(),
             Contains("coordinator of cell 'cell-1'"));
}

TEST_CASE_METHOD(membership_problem_test,
                 "a coordinator that falls silent is named to who has asked, "
                 "with a remedy") {
  form_cell();
  node.link->silent = true;
  auto reply = time.ask<request_routed>(
      node.membership, route_request{R"({"type":"task_query"})", ""});
  site.pass(limits::lease::span + 1s);
  REQUIRE(*reply);
  CHECK((*reply)->value().refusal == "unreachable");
  const auto said = json::parse((*reply)->value().text)["error"];
  CHECK(said["message"]
        == "the coordinator of cell 'cell-1' at 10.0.0.1:8420 has not "
           "answered: no heartbeat for 8 s");
  CHECK_THAT(said["hint"].get<std::string>(), Contains("roscell status"));
}

TEST_CASE_METHOD(membership_problem_test,
                 "a member returns to its cell under a new name of the cell") {
  site.base.cell_uuid = "c-1";
  form_cell();
  site.kill_coordinator();
  site.base.cell = "cell-2";
  site.start_coordinator();
  site.pass(40s);
  CHECK(state() == node_state::member);
  CHECK(site.status(node).cell == "cell-2");
  CHECK(site.base.rows.at("arm-1").registration.cell_uuid == "c-1");
}

} // namespace
