#include "actors/placement/questions/task_allocation.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

#include <set>

/// What happens between an allocation and its deployment, and what a plan
/// query may think otherwise.
namespace roscell::test {

namespace {

struct reluctant_cell : paper_cell {
  fake_agent& left = add("left");
  fake_agent& right = add("right");

  reluctant_cell() {
    base.has.cpu.used = 4;
  }

  size_t reservations() const {
    return left.reservations.size() + right.reservations.size();
  }
};

json error_in(const json& reply) {
  REQUIRE(error_of(reply) != "");
  return reply.at("error");
}

json plan_query(const std::vector<json>& steps) {
  auto query = echo_task("t", steps);
  query["type"] = "task_plan_query";
  return query;
}

/// A node on paper as a query gives it.
json paper_node(const std::string& name, double cores) {
  return {{"name", name},
          {"architecture", "amd64"},
          {"unified_memory", false},
          {"cpu", {{"capacity", cores}, {"used", 0}}},
          {"memory_mib", {{"capacity", 1000}, {"used", 0}}},
          {"disk_mib", {{"capacity", 1000}, {"used", 0}}},
          {"gpus", json::array()},
          {"labels", json::object()},
          {"devices", json::array()}};
}

} // namespace

TEST_CASE_METHOD(reluctant_cell,
                 "Room is kept at each member before anything is deployed",
                 "[placement]") {
  left.mood = temper::slow;
  post(echo_task("t", {echo_step("s0", 1, "left"), echo_step("s1", 1, "left"),
                       echo_step("s2", 1, "right")}));
  REQUIRE(left.reservations.size() == 1);
  REQUIRE(right.reservations.size() == 1);
  const auto& kept = left.reservations[0];
  CHECK(kept.task == "t");
  REQUIRE(kept.specs.size() == 2);
  CHECK(kept.specs[0].step == "s0");
  CHECK(kept.specs[0].cell == "lab");
  CHECK(left.deployments.at(0).instance == kept.specs[0].instance);
}

TEST_CASE_METHOD(reluctant_cell,
                 "A refused candidate is left out, and the reply says so",
                 "[placement]") {
  left.reluctance = 1;
  const auto reply = request(echo_task("t", {echo_step("s0", 2)}));
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("instances")[0].at("node") == "right");
  REQUIRE(reply.at("refused").size() == 1);
  const auto& refused = reply.at("refused")[0];
  CHECK(refused.at("step") == "s0");
  CHECK(refused.at("node") == "left");
  CHECK(refused.at("reason") == "refused by the node: too busy now");
  CHECK(count("allocation_refused") == 1);
  // What was kept for the first attempt is given up before the second one.
  CHECK(left.removals.size() == 1);
  CHECK(left.deployments.empty());
  CHECK(left.reservations.size() == 1);
}

TEST_CASE_METHOD(reluctant_cell,
                 "After three searches anew a task is refused, with every "
                 "refusal",
                 "[placement]") {
  left.reluctance = right.reluctance = 100;
  for (const auto* name : {"n1", "n2", "n3"})
    add(name).reluctance = 100;
  const auto error = error_in(request(echo_task("t", {echo_step("s0", 2)})));
  CHECK(error.at("code") == "no_feasible_allocation");
  CHECK(error.at("message").get<std::string>().find("too busy now")
        != std::string::npos);
  size_t asked = 0;
  for (const auto& x : agents)
    asked += x->reservations.size();
  CHECK(asked == 4);
  CHECK(count("allocation_refused") == 4);
  CHECK(count("task_failed") == 0);
  CHECK(tasks().empty());
  // The turn goes on.
  left.reluctance = 0;
  CHECK(request(echo_task("u", {echo_step("s0", 2, "left")})).at("type")
        == "task_accepted");
}

TEST_CASE_METHOD(reluctant_cell,
                 "The only node is asked once more, for it may have been busy "
                 "for a moment",
                 "[placement]") {
  left.reluctance = 1;
  const auto reply = request(echo_task("t", {echo_step("s0", 2, "left")}));
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(reply.at("refused").size() == 1);
  CHECK(left.reservations.size() == 2);
}

TEST_CASE_METHOD(reluctant_cell,
                 "Where nothing is left after refusals, the answer explains "
                 "both",
                 "[placement]") {
  left.reluctance = 2;
  const auto error =
      error_in(request(echo_task("t", {echo_step("s0", 2, "left")})));
  CHECK(error.at("code") == "no_feasible_allocation");
  CHECK(error.at("hint").get<std::string>().find("too busy now")
        != std::string::npos);
  bool explained = false;
  for (const auto& x : error.at("rejected"))
    for (const auto& cause : x.at("causes"))
      explained = explained || cause.at("kind") == "excluded";
  CHECK(explained);
}

TEST_CASE_METHOD(
    reluctant_cell,
    "Room that a member keeps and the coordinator holds counts once",
    "[placement]") {
  right.has.cpu.used = 4;
  left.reports_reserved = true;
  // The second one asks when the intent of the first one is held, but not
  // deployed yet.
  slow_disk = true;
  const auto first = post(echo_task("t0", {echo_step("s0", 2)}));
  const auto second = post(echo_task("t1", {echo_step("s0", 2)}));
  slow_disk = false;
  finish_writes();
  time.settle();
  CHECK(left.reservations.size() == 2);
  CHECK(reply_of(first).at("type") == "task_accepted");
  CHECK(reply_of(second).at("type") == "task_accepted");
  CHECK(error_of(request(echo_task("t2", {echo_step("s0", 1)})))
        == "no_feasible_allocation");
}

TEST_CASE("A guard hears of the nodes of its search only", "[placement]") {
  search_guard guard;
  guard.begin({"left", "right"});
  guard.node_left("somebody");
  CHECK_FALSE(guard.must_stop());
  guard.node_left("right");
  guard.node_left("left");
  CHECK(guard.must_stop());
  CHECK(guard.end() == "right");
  guard.begin({"left"});
  CHECK_FALSE(guard.must_stop());
  CHECK(guard.end().empty());
}

TEST_CASE("A search ends when one of its nodes leaves in the middle",
          "[placement]") {
  allocate_task asked;
  std::set<std::string> names;
  for (int v = 0; v < 12; ++v) {
    asked.nodes.push_back(paper_node("n" + std::to_string(v), 4 + v % 5));
    asked.nodes.back().memory_mib.used = 40 * v;
    names.insert(asked.nodes.back().name);
  }
  for (int i = 0; i < 6; ++i) {
    resolved_step step;
    step.step.id = "s" + std::to_string(i);
    step.builds = {
        {"h", echo_skill().descriptor.models[0], {names.begin(), names.end()}}};
    asked.steps.push_back(step);
  }
  search_guard guard;
  guard.begin(names);
  size_t states = 0;
  auto found = allocate(asked, 0ms, [&] {
    if (++states == 50)
      guard.node_left("n3");
    return guard.must_stop();
  });
  CHECK(states == 50);
  CHECK(guard.end() == "n3");
  REQUIRE(std::holds_alternative<task_plan>(found));
  const auto& plan = std::get<task_plan>(found);
  CHECK_FALSE(plan.optimal);
  CHECK(plan.score.gap > 0);
  CHECK(plan.score.lower_bound == Approx(plan.score.total - plan.score.gap));
}

TEST_CASE_METHOD(reluctant_cell, "A plan may think nodes away and add others",
                 "[placement]") {
  auto query = plan_query({echo_step("s0", 3)});
  query["without"] = {"left", "right"};
  auto error = error_in(request(query));
  CHECK(error.at("code") == "no_feasible_allocation");
  query["with"] = {paper_node("spare", 8)};
  const auto plan = request(query);
  REQUIRE(plan.at("type") == "task_plan");
  CHECK(plan.at("allocations")[0].at("node") == "spare");
  CHECK(plan.at("use")[0].at("node") == "spare");
  CHECK(plan.at("use")[0].at("after") == 3);
  CHECK(reservations() == 0);

  query["without"] = {"nobody"};
  error = error_in(request(query));
  CHECK(error.at("code") == "unknown_node");
  CHECK(error.at("where") == "/without/0");
  query.erase("without");
  query["with"] = {paper_node("left", 8)};
  error = error_in(request(query));
  CHECK(error.at("code") == "conflict");
  CHECK(error.at("where") == "/with/0/name");
}

TEST_CASE_METHOD(reluctant_cell, "A plan says why a step is where it is",
                 "[placement]") {
  left.has.cpu.capacity = 8;
  auto query = plan_query({echo_step("s0", 3)});
  query["why"] = "s0";
  const auto plan = request(query);
  REQUIRE(plan.at("alternatives").size() == 1);
  const auto& other = plan.at("alternatives")[0];
  CHECK(other.at("step") == "s0");
  CHECK(other.at("allocations")[0].at("node")
        != plan.at("allocations")[0].at("node"));
  CHECK(other.at("extra").get<double>()
        == Approx(other.at("score").at("total").get<double>()
                  - plan.at("score").at("total").get<double>()));
  CHECK(other.at("extra").get<double>() > 0);
  query["why"] = "s1";
  CHECK(error_in(request(query)).at("where") == "/why");
}

} // namespace roscell::test
