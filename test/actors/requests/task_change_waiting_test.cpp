#include "actors/requests/handlers/task_pipeline.hpp"
#include "actors/requests/limits.hpp"
#include "actors/session/limits.hpp"

#include "test/actors/requests/processing.hpp"

#include <vector>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A coordinator that knows one task or none, and its event log.
struct change_fixture {
  virtual_time time;
  std::shared_ptr<node_services> services = std::make_shared<node_services>();
  task_description known;
  size_t asked = 0;
  std::vector<event_listener_actor> listeners;
  caf::actor events;
  caf::actor coordinator;

  change_fixture() {
    events = time.system.spawn([this]() -> caf::behavior {
      return {[this](const subscribe_events& x) {
        listeners.push_back(x.listener);
      }};
    });
    coordinator = time.system.spawn([this]() -> caf::behavior {
      return {[this](const task_query&) -> caf::result<task_description> {
        ++asked;
        if (known.tasks.empty())
          return to_error(
              {error_code::unknown_task, "no such task", "", "", ""});
        return known;
      }};
    });
    services->context = time.context;
    services->context.events = caf::actor_cast<event_log_actor>(events);
    services->coordinator =
        caf::actor_cast<cell_coordinator_actor>(coordinator);
  }

  ~change_fixture() {
    listeners.clear();
    time.kill(coordinator);
    time.kill(events);
  }

  change_fixture(const change_fixture&) = delete;
  change_fixture& operator=(const change_fixture&) = delete;

  void put(task_state state) {
    task_row row;
    row.task = "t";
    row.state = state;
    known.tasks = {row};
  }

  void publish_event(const std::string& what, const std::string& subject,
                     const std::string& data = {}, bool passing = false) {
    event e;
    e.passing = passing;
    e.what = what;
    e.subject = subject;
    e.data = data;
    for (const auto& x : listeners)
      caf::anon_send(x, e);
    time.settle();
  }

  processed_reply ask(const std::string& mark, std::chrono::milliseconds wait) {
    return process(time, services, await_task_change,
                   message_json(task_change_query{"t", mark, wait.count()}));
  }

  static task_change reported(const processed_reply& reply) {
    REQUIRE(*reply);
    REQUIRE(**reply);
    return json::parse((**reply)->text).get<task_change>();
  }
};

} // namespace

TEST_CASE_METHOD(change_fixture, "Who knows nothing of a task is told at once",
                 "[task_change]") {
  put(task_state::running);
  const auto first = reported(ask("", limits::task::change_wait));
  REQUIRE(first.tasks.size() == 1);
  CHECK(first.tasks[0].state == task_state::running);
  known.tasks.clear();
  const auto gone = reported(ask(first.mark, limits::task::change_wait));
  CHECK(gone.tasks.empty());
  CHECK(gone.mark != first.mark);
}

TEST_CASE_METHOD(change_fixture,
                 "Who knows how a task stands is told when that changes, and "
                 "by nothing else",
                 "[task_change]") {
  put(task_state::deploying);
  const auto mark = mark_of(known);
  const auto reply = ask(mark, 20s);
  asked = 0;
  SECTION("what concerns others is not asked for") {
    put(task_state::running);
    publish_event("instance_changed", "x", R"({"task":"other"})");
    publish_event("task_accepted", "other");
    CHECK(asked == 0);
    CHECK_FALSE(*reply);
  }
  SECTION("what changes nothing is no answer") {
    publish_event("instance_changed", "x", R"({"task":"t"})");
    CHECK(asked == 1);
    CHECK_FALSE(*reply);
  }
  SECTION("a task") {
    put(task_state::running);
    publish_event("task_accepted", "t");
    CHECK(reported(reply).tasks[0].state == task_state::running);
  }
  SECTION("an instance of it") {
    put(task_state::running);
    publish_event("instance_changed", "x", R"({"task":"t"})");
    CHECK(reported(reply).mark != mark);
  }
  SECTION("an instance that starts again and again, which is only counted") {
    put(task_state::degraded);
    publish_event("instance_changed", "x", R"({"task":"t"})", true);
    CHECK(reported(reply).mark != mark);
  }
  SECTION("a node") {
    put(task_state::degraded);
    publish_event("node_lost", "arm");
    CHECK(reported(reply).tasks[0].state == task_state::degraded);
  }
  SECTION("data that is no JSON") {
    publish_event("instance_changed", "x", "{");
    CHECK_FALSE(*reply);
  }
}

TEST_CASE_METHOD(change_fixture,
                 "A wait for a change ends with what is known, when it is over "
                 "and not before",
                 "[task_change]") {
  const auto wait = GENERATE(0ms, 1ms, 20'000ms);
  put(task_state::running);
  const auto mark = mark_of(known);
  const auto reply = ask(mark, wait);
  if (wait > 0ms) {
    time.pass(wait - 1ms);
    CHECK_FALSE(*reply);
  }
  time.pass(1ms);
  CHECK(reported(reply).mark == mark);
}

TEST_CASE_METHOD(change_fixture,
                 "As many wait for changes as there are places, and a place is "
                 "given back",
                 "[task_change]") {
  put(task_state::running);
  const auto mark = mark_of(known);
  std::vector<processed_reply> waiting;
  for (size_t i = 0; i < limits::task::change_waiters; ++i)
    waiting.push_back(ask(mark, 20s));
  CHECK_FALSE(*waiting.back());
  const auto refused = ask(mark, 20s);
  REQUIRE(*refused);
  REQUIRE_FALSE(**refused);
  CHECK(to_failure((*refused)->error()).code == error_code::conflict);
  time.pass(20s);
  for (const auto& x : waiting)
    CHECK(reported(x).mark == mark);
  listeners.clear();
  CHECK_FALSE(*ask(mark, 20s));
  time.pass(20s);
}

TEST_CASE_METHOD(change_fixture,
                 "Who waits for a change is told when nobody can say it any "
                 "more",
                 "[task_change]") {
  put(task_state::running);
  const auto reply = ask(mark_of(known), 20s);
  time.kill(coordinator);
  REQUIRE(*reply);
  CHECK_FALSE(**reply);
}

} // namespace roscell::test
