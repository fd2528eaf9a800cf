#include "test/site/site_skills.hpp"
#include "test/site/watch/site_watch.hpp"
#include "test/site/watch/task_rest.hpp"

#include <algorithm>

/// What becomes of tasks while nodes come and go, one fault at a time.
namespace {

using namespace roscell;
using namespace roscell::test;

/// Two cells, one with two nodes, and nothing is wrong.
struct task_site {
  virtual_time clock;
  site place{clock, 1};
  site_watch watch{place};
  site_party& base = place.add_coordinator("c-0");
  site_party& other = place.add_coordinator("c-1");
  site_party& arm = place.add_node(base.discovery_server);
  site_party& leg = place.add_node(base.discovery_server);

  task_site() {
    for (auto& x : place.parties)
      place.start(*x);
    watch.live(20s);
    REQUIRE(complaint(place).empty());
  }

  /// Requests a task of these steps; the request has its answer when it is
  /// back.
  site_task& run(const std::vector<json>& steps) {
    auto& task = place.add_task(base, steps);
    place.request(task);
    watch.live(5s);
    return task;
  }

  json state_of(const site_task& task) {
    auto reply =
        clock.ask<task_description>(base.coordinator, task_query{task.name});
    place.pass(1ms);
    REQUIRE(reply->has_value());
    return **reply ? json((**reply)->tasks.front()) : json{};
  }

  size_t programs(const site_party& x) const {
    return static_cast<size_t>(
        std::count_if(x.programs.begin(), x.programs.end(), [&](const auto& p) {
          return p.second.runs(place.now());
        }));
  }

  /// What is wrong in the end, once every task has been ended.
  std::string verdict() {
    auto result = calm_down(place);
    result += end_all_tasks(place);
    for (const auto& x : place.violations)
      result += x + "; ";
    return result;
  }
};

json on(const site_party& node, const program_script& script = {},
        const std::string& id = "s") {
  return work_step(id, script, tiny_deployment, node.name);
}

json on_any_member() {
  auto result = work_step("s", {}, tiny_deployment);
  result["labels"] = {{"coordinates", "no"}};
  return result;
}

program_script short_work() {
  program_script x;
  x.ends_ms = 100;
  return x;
}

/// More than a node remembers the ends of.
std::vector<json> burst_on(const site_party& node) {
  std::vector<json> steps;
  for (int i = 0; i < 40; ++i)
    steps.push_back(on(node, short_work(), "s" + std::to_string(i)));
  return steps;
}

TEST_CASE("finished work is not done again when its node comes back",
          "[tasks]") {
  task_site x;
  const auto& task = x.run(burst_on(x.arm));
  REQUIRE(task.calls[0].accepted());
  const auto started = x.place.containers;
  SECTION("from a pause") {
    x.place.freeze(x.arm);
    x.watch.live(12s);
    x.place.thaw(x.arm);
  }
  SECTION("from a restart") {
    x.place.kill(x.arm);
    x.place.start(x.arm);
  }
  SECTION("to a coordinator that was started again") {
    x.place.kill(x.base);
    x.place.start(x.base);
  }
  x.watch.live(60s);
  CHECK(x.place.containers == started);
  CHECK(x.verdict() == "");
}

TEST_CASE("a node that is being deployed to is not let go", "[tasks]") {
  task_site x;
  program_script slow;
  slow.ready_ms = 5000;
  auto& task = x.place.add_task(x.base, {on(x.arm, slow)});
  x.place.request(task);
  x.watch.live(1s);
  x.place.ask<node_released>(x.base, node_release{x.arm.name});
  x.watch.live(10s);
  REQUIRE(x.place.requests[0].is_answered());
  const auto why = x.place.requests[0].refusal();
  REQUIRE(why);
  CHECK(why->code == error_code::conflict);
  CHECK(task.calls[0].accepted());
  CHECK(x.verdict() == "");
}

TEST_CASE("a task that is ended while it moves leaves nothing", "[tasks]") {
  for (auto delay = 0ms; delay <= 1000ms; delay += 50ms) {
    task_site x;
    x.place.faults.shortest_delay = x.place.faults.longest_delay = 20ms;
    // Both are on the one member that is there, and may go to the other.
    x.place.kill(x.leg);
    auto& a = x.run({on_any_member()});
    auto& b = x.run({on_any_member()});
    x.place.start(x.leg);
    x.watch.live(20s);
    x.place.ask<node_released>(
        x.base, node_release{x.arm.name, instance_policy::reschedule});
    x.watch.live(delay);
    x.place.terminate(a);
    x.watch.live(60s);
    CHECK(b.calls[0].accepted());
    INFO("terminated after " << delay.count() << " ms");
    CHECK(x.verdict() == "");
  }
}

TEST_CASE("a node that dies while it goes can be released", "[tasks]") {
  task_site x;
  x.place.ask<node_transferred>(x.base,
                                node_transfer{x.arm.name, x.other.cell});
  x.place.pass_until(5s, [&] {
    return std::any_of(
        x.place.events.begin(), x.place.events.end(),
        [](const auto& event) { return event.what == "switch_accepted"; });
  });
  x.arm.retired = true;
  x.place.kill(x.arm);
  CHECK(calm_down(x.place) == "");
  CHECK(release_retired(x.place) == "");
}

TEST_CASE("what is accepted outlives its coordinator's death", "[tasks]") {
  task_site x;
  const auto& task = x.run({on(x.arm), on(x.base, {}, "here")});
  REQUIRE(task.calls[0].accepted());
  x.place.kill(x.base);
  x.watch.live(3s);
  x.place.start(x.base);
  x.watch.live(40s);
  CHECK(x.state_of(task).at("state") == "running");
  CHECK(x.place.containers == 2);
  CHECK(x.verdict() == "");
}

} // namespace
