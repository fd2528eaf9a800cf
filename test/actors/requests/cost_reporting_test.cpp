#include "actors/core/answer_limits.hpp"
#include "actors/requests/handlers/insight.hpp"

#include "test/actors/requests/processing.hpp"

#include <functional>
#include <map>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

using relayed = std::function<caf::result<request_routed>(const json& asked)>;

/// The node "base" and a coordinator whose nodes answer as the test says.
struct cost_fixture {
  virtual_time time;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  std::map<std::string, relayed> nodes; ///< By name.
  caf::actor coordinator;

  cost_fixture() {
    services->context = time.context;
    services->name = "base";
    services->costs = std::make_shared<cost_meter>([] {
      return cost_reading{2, 1000, 0, {}};
    });
    coordinator = time.system.spawn([this]() -> caf::behavior {
      return {
          [this](const cell_query&) {
            cell_description cell;
            cell.nodes.push_back(row("base"));
            for (const auto& [name, answer] : nodes)
              cell.nodes.push_back(row(name));
            return cell;
          },
          [this](const relay_request& x) {
            return nodes.at(x.node)(json::parse(x.text));
          },
      };
    });
  }

  ~cost_fixture() {
    time.kill(coordinator);
  }

  cost_fixture(const cost_fixture&) = delete;
  cost_fixture& operator=(const cost_fixture&) = delete;

  static registry_row row(const std::string& name) {
    registry_row result;
    result.identity.name = name;
    return result;
  }

  /// This is a coordination node.
  void coordinate() {
    services->coordinator =
        caf::actor_cast<cell_coordinator_actor>(coordinator);
  }

  /// What a node says that calls itself so.
  static std::string report(const std::string& name) {
    return message_json(
               cost_report{{{name, {{"minute", 60, 1, 2000, 3, {}}}, ""}}})
        .dump();
  }

  std::vector<node_cost> ask(const cost_query& query) {
    const auto reply =
        process(time, services, report_cost, message_json(query));
    time.pass(limits::local::answer + relay_margin);
    REQUIRE(*reply);
    REQUIRE(**reply);
    return json::parse((**reply)->text).get<cost_report>().nodes;
  }
};

} // namespace

TEST_CASE_METHOD(cost_fixture, "A node tells what it costs itself", "[cost]") {
  coordinate();
  nodes["arm"] = [](const json&) { return request_routed{report("arm"), ""}; };
  const auto reported = ask({});
  REQUIRE(reported.size() == 1);
  CHECK(reported[0].node == "base");
  REQUIRE(reported[0].windows.size() == 3);
  CHECK(reported[0].windows[0].pss_bytes == 1000);
  CHECK(reported[0].problem.empty());
}

TEST_CASE_METHOD(cost_fixture,
                 "A coordinator tells what each node of its cell says of "
                 "itself",
                 "[cost]") {
  coordinate();
  std::vector<json> asked;
  for (const auto* name : {"arm", "leg"})
    nodes[name] = [&, name](const json& question) {
      asked.push_back(question);
      return request_routed{report(name), ""};
    };
  const auto reported = ask({"", true});
  REQUIRE(reported.size() == 3);
  CHECK(reported[0].node == "base");
  CHECK(reported[1] == node_cost{"arm", {{"minute", 60, 1, 2000, 3, {}}}, ""});
  CHECK(reported[2].node == "leg");
  REQUIRE(asked.size() == 2);
  CHECK(asked[0].get<cost_query>() == cost_query{});
}

TEST_CASE_METHOD(cost_fixture, "A node that is away has a problem instead",
                 "[cost]") {
  coordinate();
  nodes["arm"] = [](const json&) {
    return fail(error_code::unreachable, "node 'arm' is away");
  };
  const auto reported = ask({"", true});
  REQUIRE(reported.size() == 2);
  CHECK(reported[1] == node_cost{"arm", {}, "node 'arm' is away"});
}

TEST_CASE_METHOD(cost_fixture,
                 "A node that gives no answer holds up the others no longer "
                 "than its time",
                 "[cost]") {
  coordinate();
  nodes["arm"] = [](const json&) { return caf::delegated<request_routed>{}; };
  nodes["leg"] = [](const json&) { return request_routed{report("leg"), ""}; };
  const auto reported = ask({"", true});
  REQUIRE(reported.size() == 3);
  CHECK(reported[1].windows.empty());
  CHECK_FALSE(reported[1].problem.empty());
  CHECK(reported[2].windows.size() == 1);
}

TEST_CASE_METHOD(cost_fixture, "A node cannot speak for another one",
                 "[cost]") {
  coordinate();
  nodes["arm"] = [](const json&) { return request_routed{report("leg"), ""}; };
  const auto two =
      message_json(cost_report{{{"arm", {}, ""}, {"leg", {}, ""}}}).dump();
  nodes["leg"] = [two](const json&) { return request_routed{two, ""}; };
  nodes["toe"] = [](const json&) {
    return request_routed{R"({"type":"cell_list","cells":[]})", ""};
  };
  const auto reported = ask({"", true});
  REQUIRE(reported.size() == 4);
  CHECK(reported[1].node == "arm");
  CHECK(reported[1].windows.size() == 1);
  CHECK(reported[2] == node_cost{"leg", {}, "it tells of 2 nodes"});
  CHECK(reported[3].windows.empty());
  CHECK(reported[3].problem.find("cost_report") != std::string::npos);
}

} // namespace roscell::test
