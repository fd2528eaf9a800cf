#include "actors/placement/scheduler.hpp"

#include "actors/placement/searcher.hpp"
#include "messages/failure.hpp"
#include "test/fixture.hpp"

#include <map>
#include <vector>

namespace roscell::test {

namespace {

using searcher_pointer = scheduler_actor::stateful_pointer<searcher_state>;

/// A scheduler over searchers that answer when they are told to.
struct bench : virtual_time {
  bench() {
    scheduler_config config;
    config.guard = std::make_shared<search_guard>();
    config.make_searcher = [this](const auto& guard, const auto&) {
      guards.push_back(guard);
      searchers.push_back(system.spawn([this](scheduler_actor::pointer self)
                                           -> scheduler_actor::behavior_type {
        return {
            [](const state_query&) { return state_of(json::object()); },
            [this, self](const allocate_task& x) {
              auto promise = self->make_response_promise<task_plan>();
              // One that thinks hears no other question.
              auto& held = waiting[self->id()];
              if (held.empty() && (!x.trial || !busy))
                promise.deliver(task_plan{x.task});
              else
                held.push_back(promise);
              return promise;
            },
            [](const plan_moves&) { return moves_planned{}; },
        };
      }));
      return searchers.back();
    };
    guard = config.guard;
    scheduler = roscell::spawn(system, context, roscell::scheduler, config);
  }

  ~bench() {
    waiting.clear();
    kill(scheduler);
    for (const auto& x : searchers)
      kill(x);
  }

  auto question(const std::string& task, bool trial) {
    allocate_task request;
    request.task = task;
    request.trial = trial;
    auto answer = ask<task_plan>(scheduler, request);
    settle();
    return answer;
  }

  bool busy = true; ///< With a plan query.
  /// By searcher.
  std::map<caf::actor_id, std::vector<caf::typed_response_promise<task_plan>>>
      waiting;
  std::vector<std::shared_ptr<search_guard>> guards;
  std::vector<scheduler_actor> searchers;
  std::shared_ptr<search_guard> guard;
  scheduler_actor scheduler;
};

} // namespace

TEST_CASE("A plan query at work does not hold up a live request",
          "[scheduler]") {
  bench b;
  const auto plan = b.question("thought", true);
  const auto live = b.question("real", false);
  CHECK_FALSE(*plan);
  REQUIRE(*live);
  REQUIRE(**live);
  CHECK((**live)->task == "real");
}

TEST_CASE("A plan of moves does not hold up a live request", "[scheduler]") {
  bench b;
  const auto moves = b.ask<moves_planned>(b.scheduler, plan_moves{});
  b.settle();
  REQUIRE(*moves);
  REQUIRE(b.guards.size() == 1);
  CHECK(b.guards[0] != b.guard);
}

TEST_CASE("Nodes that leave end the searches for live requests only",
          "[scheduler]") {
  bench b;
  b.question("thought", true);
  b.question("real", false);
  REQUIRE(b.guards.size() == 2);
  CHECK(b.guards[0] != b.guard);
  CHECK(b.guards[1] == b.guard);
}

TEST_CASE("A searcher is made when there is a question, and once",
          "[scheduler]") {
  bench b;
  b.busy = false;
  b.settle();
  CHECK(b.searchers.empty());
  b.question("a", false);
  b.question("b", false);
  CHECK(b.searchers.size() == 1);
  b.question("c", true);
  CHECK(b.searchers.size() == 2);
}

TEST_CASE("A searcher that has died is replaced with the next question",
          "[scheduler]") {
  bench b;
  b.question("a", false);
  b.kill(b.searchers[0]);
  const auto answer = b.question("b", false);
  CHECK(b.searchers.size() == 2);
  REQUIRE(*answer);
  CHECK(**answer);
}

TEST_CASE("A searcher ends with its scheduler", "[scheduler]") {
  virtual_time time;
  scheduler_config config;
  config.guard = std::make_shared<search_guard>();
  scheduler_actor child;
  config.make_searcher = [&](auto guard, const auto& owner) {
    child =
        spawn(time.system, time.context, searcher, time.context, guard, owner);
    return child;
  };
  auto parent = spawn(time.system, time.context, scheduler, config);
  time.ask<task_plan>(parent, allocate_task{});
  time.settle();
  REQUIRE(child);
  bool ended = false;
  child->attach_functor([&ended] { ended = true; });
  time.kill(parent);
  time.settle();
  CHECK(ended);
}

} // namespace roscell::test
