#include "actors/core/answer_limits.hpp"
#include "actors/requests/handlers/insight.hpp"
#include "test/actors/requests/processing.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <map>
#include <stdexcept>

namespace roscell::test {

namespace {

struct watched_state {
  static constexpr const char* name = "watched";
};

/// Answers what it is told to, or nothing.
introspected_actor::behavior_type
watched(introspected_actor::stateful_pointer<watched_state> self,
        const std::string& knows) {
  return {
      [self, knows](const state_query&) -> caf::result<actor_state> {
        if (knows.empty())
          return self->make_response_promise<actor_state>();
        return actor_state{knows};
      },
  };
}

struct inspection_fixture {
  virtual_time time;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  std::vector<introspected_actor> actors;

  inspection_fixture() {
    services->context = time.context;
  }

  ~inspection_fixture() {
    for (auto& x : actors)
      time.kill(x);
  }

  introspected_actor start(const std::string& knows) {
    actors.push_back(spawn(time.system, time.context, watched, knows));
    time.settle();
    return actors.back();
  }

  caf::expected<request_processed> inspect(const std::string& actor) {
    const auto reply = process(time, services, inspect_actors,
                               {{"type", "actor_query"}, {"actor", actor}});
    time.pass(limits::local::answer);
    REQUIRE(*reply);
    return **reply;
  }

  json rows(const std::string& actor) {
    const auto reply = inspect(actor);
    REQUIRE(reply);
    return json::parse(reply->text).at("actors");
  }
};

} // namespace

TEST_CASE_METHOD(inspection_fixture,
                 "An actor is looked into by its id, or with all of its name",
                 "[inspection]") {
  start(R"({"n":1})");
  const auto second = start(R"({"n":2})");
  const auto both = rows("watched");
  REQUIRE(both.size() == 2);
  CHECK(both[0].at("state") == json{{"n", 1}});
  const auto one = rows(std::to_string(second.id()));
  REQUIRE(one.size() == 1);
  CHECK(one[0].at("state") == json{{"n", 2}});
  CHECK(one[0].at("counters").at("name") == "watched");
}

TEST_CASE_METHOD(inspection_fixture,
                 "An actor that gives no answer in time has its counters",
                 "[inspection]") {
  start("");
  const auto all = rows("watched");
  REQUIRE(all.size() == 1);
  CHECK(all[0].count("state") == 0);
  CHECK(all[0].at("counters").at("name") == "watched");
}

TEST_CASE_METHOD(inspection_fixture, "An actor that has ended is not found",
                 "[inspection]") {
  const auto id = std::to_string(start(R"({"n":1})").id());
  time.kill(actors.back());
  actors.clear();
  const auto reply = inspect(id);
  REQUIRE_FALSE(reply);
  CHECK(to_failure(reply.error()).code == error_code::unknown_task);
  CHECK_FALSE(inspect("nobody"));
}

TEST_CASE("A host is looked at by one at a time, and after a failure again",
          "[host_checking]") {
  int looks = 0;
  std::function<findings()> again;
  const auto look = one_at_a_time([&] {
    ++looks;
    if (looks == 1)
      throw std::runtime_error{"no thread is left"};
    CHECK(again().empty());
    return findings{{judgement::ok, "well"}};
  });
  again = look;
  CHECK_THROWS(look());
  CHECK(look().size() == 1);
  CHECK(looks == 2);
}

TEST_CASE("A program that cannot look at its host says nothing",
          "[host_checking]") {
  CHECK_FALSE(one_at_a_time(nullptr));
}

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
