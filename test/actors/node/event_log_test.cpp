#include "actors/node/event_log.hpp"
#include "actors/node/limits.hpp"
#include "messages/failure.hpp"
#include "test/fixture.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace roscell::test {

namespace {

event_kind kind_named(std::string_view name) {
  return {name, "", "", ""};
}

caf::behavior listener(caf::event_based_actor*, std::vector<event>* seen) {
  return {[=](const event& x) { seen->push_back(x); }};
}

struct log_fixture {
  virtual_time time;
  event_log_actor log =
      spawn(time.system, time.context, event_log, event_log_setup{});
  std::vector<event> seen;
  caf::actor ear = time.system.spawn(listener, &seen);

  ~log_fixture() {
    time.kill(ear);
    time.kill(log);
  }

  void publish_event(const std::string& what,
                     const std::string& subject = "arm") {
    actor_context{nullptr, log}.publish_event(kind_named(what), subject,
                                              {{"n", 1}});
    time.settle();
  }

  void listen(const caf::actor& whom, uint64_t since = 0) {
    caf::anon_send(
        log,
        subscribe_events{caf::actor_cast<event_listener_actor>(whom), since});
    time.settle();
  }

  json state() {
    auto reply = time.ask<actor_state>(log, state_query{});
    time.settle();
    return json::parse((*reply)->value().json_text);
  }
};

} // namespace

TEST_CASE_METHOD(log_fixture, "Events are numbered from 1 without a gap",
                 "[event_log]") {
  listen(ear);
  for (int i = 0; i < 5; ++i)
    publish_event("node_joined");
  REQUIRE(seen.size() == 5);
  for (size_t i = 0; i < 5; ++i)
    CHECK(seen[i].sequence == i + 1);
  CHECK(seen[0].what == "node_joined");
  CHECK(seen[0].subject == "arm");
  CHECK(json::parse(seen[0].data) == json{{"n", 1}});
  CHECK(seen[0].time_unix_ms > 0);
}

TEST_CASE_METHOD(log_fixture, "What is kept is told without listening on",
                 "[event_log]") {
  for (const auto* what : {"node_joined", "node_lost", "node_left"})
    publish_event(what);
  auto reply = time.ask<kept_events>(log, kept_events_query{1});
  time.settle();
  const auto& events = (*reply)->value().events;
  REQUIRE(events.size() == 2);
  CHECK(events[0].what == "node_lost");
  CHECK(events[1].sequence == 3);
  CHECK(state().at("listeners") == 0);
}

TEST_CASE_METHOD(log_fixture, "A late listener first gets what it has not seen",
                 "[event_log]") {
  for (int i = 0; i < 5; ++i)
    publish_event("node_joined");
  listen(ear, 3);
  publish_event("node_left");
  REQUIRE(seen.size() == 3);
  CHECK(seen[0].sequence == 4);
  CHECK(seen[1].sequence == 5);
  CHECK(seen[2].what == "node_left");
}

TEST_CASE_METHOD(log_fixture, "The newest 1000 events are kept",
                 "[event_log]") {
  for (int i = 0; i < 1200; ++i)
    publish_event("node_joined", "arm-" + std::to_string(i));
  CHECK(state().at("kept") == 1000);
  listen(ear);
  REQUIRE(seen.size() == 1000);
  CHECK(seen.front().sequence == 201);
  CHECK(seen.back().sequence == 1200);
}

TEST_CASE_METHOD(log_fixture,
                 "Refusals without end leave room for other events",
                 "[event_log]") {
  listen(ear);
  publish_event("node_joined");
  for (int i = 0; i < 1300; ++i)
    publish_event("session_refused");
  CHECK(seen.size() == 1 + limits::event::refusals);
  time.advance(limits::event::refusal_window);
  REQUIRE(seen.size() == 2 + limits::event::refusals);
  CHECK(seen.back().what == "session_refused");
  CHECK(json::parse(seen.back().data).at("more") == 1295);
  CHECK(state().at("kept") == seen.size());
}

TEST_CASE_METHOD(log_fixture, "A listener that ends is forgotten",
                 "[event_log]") {
  listen(ear);
  CHECK(state().at("listeners") == 1);
  time.kill(ear);
  CHECK(state().at("listeners") == 0);
  publish_event("node_joined");
  CHECK(seen.empty());
}

TEST_CASE_METHOD(log_fixture,
                 "A listener that is dead when it subscribes is forgotten",
                 "[event_log]") {
  time.kill(ear);
  listen(ear);
  CHECK(state().at("listeners") == 0);
}

TEST_CASE_METHOD(log_fixture, "Without a log, events go nowhere",
                 "[event_log]") {
  actor_context{nullptr, {}}.publish_event(events::node_joined, "arm");
  CHECK(state().at("last_sequence") == 0);
}

namespace {

/// What a log has had written.
struct written_batches {
  std::vector<event_batch> batches;
  bool is_full = false; ///< The disk.
  bool has_ended = false;
};

node_history_actor::behavior_type fake_history(node_history_actor::pointer self,
                                               written_batches* seen) {
  self->attach_functor([seen] { seen->has_ended = true; });
  return {
      [](const state_query&) { return state_of(json::object()); },
      [seen](const event_batch& x) -> caf::result<events_written> {
        if (seen->is_full)
          return fail(error_code::internal, "no room", {}, "free some");
        seen->batches.push_back(x);
        return events_written{5000};
      },
      [](const past_events_query&) {
        return kept_events{{event{1, 1, "node_lost", "arm", ""}}};
      },
      [](const log_kept&) {},
      [](const log_query&) { return log_excerpt{}; },
      [](const kept_logs_query&) { return kept_logs{}; },
  };
}

struct kept_log_fixture {
  written_batches disk;
  virtual_time time;
  node_history_actor history = time.system.spawn(fake_history, &disk);
  event_log_actor log =
      spawn(time.system, time.context, event_log, event_log_setup{history, 41});

  ~kept_log_fixture() {
    time.kill(log);
    time.kill(history);
  }

  void publish_event(const std::string& what,
                     const std::string& subject = "arm") {
    actor_context{nullptr, log}.publish_event(kind_named(what), subject);
    time.settle();
  }

  void end() {
    caf::anon_send_exit(log, caf::exit_reason::user_shutdown);
    time.settle();
  }

  size_t written() const {
    size_t result = 0;
    for (const auto& x : disk.batches)
      result += x.events.size();
    return result;
  }
};

} // namespace

TEST_CASE_METHOD(kept_log_fixture, "Events are written together, soon, once",
                 "[event_log]") {
  publish_event("node_joined");
  time.advance(limits::history::batch_span / 2);
  publish_event("node_lost");
  CHECK(disk.batches.empty());
  time.advance(limits::history::batch_span / 2);
  REQUIRE(disk.batches.size() == 1);
  REQUIRE(disk.batches[0].events.size() == 2);
  CHECK(disk.batches[0].events[0].sequence == 42);
  CHECK(disk.batches[0].events[1].what == "node_lost");
  CHECK_FALSE(disk.batches[0].last);
  time.advance(std::chrono::hours{24});
  CHECK(disk.batches.size() == 1);
}

TEST_CASE_METHOD(kept_log_fixture, "Many events do not wait", "[event_log]") {
  const auto many = limits::history::batch;
  for (size_t i = 0; i < many - 1; ++i)
    publish_event("node_joined", std::to_string(i));
  CHECK(written() == 0);
  publish_event("node_joined", "last");
  CHECK(written() == many);
}

TEST_CASE_METHOD(kept_log_fixture, "A node that ends has written all",
                 "[event_log]") {
  SECTION("what waits") {
    publish_event("node_stopping");
    end();
    CHECK(written() == 1);
  }
  SECTION("what was only counted") {
    for (size_t i = 0; i < 3 * limits::event::repetitions; ++i)
      publish_event("instance_changed");
    end();
    REQUIRE(written() == limits::event::repetitions + 1);
    const auto& last = disk.batches.back().events.back();
    CHECK(json::parse(last.data).at("more") == 2 * limits::event::repetitions);
  }
  SECTION("nothing: numbers end there") {
    end();
  }
  REQUIRE_FALSE(disk.batches.empty());
  CHECK(disk.batches.back().last);
  CHECK(disk.has_ended);
}

TEST_CASE_METHOD(kept_log_fixture,
                 "What finds no room is told once and written later",
                 "[event_log]") {
  disk.is_full = true;
  publish_event("node_joined");
  time.advance(20 * limits::history::batch_span);
  CHECK(written() == 0);
  disk.is_full = false;
  time.advance(limits::history::batch_span);
  REQUIRE(written() == 2);
  CHECK(disk.batches[0].events[0].what == "node_joined");
  CHECK(disk.batches[0].events[1].what == "history_failed");
}

TEST_CASE_METHOD(kept_log_fixture,
                 "What finds no room for long is bounded in memory",
                 "[event_log]") {
  disk.is_full = true;
  for (size_t i = 0; i < 3 * limits::event::kept; ++i)
    publish_event("node_joined", std::to_string(i));
  disk.is_full = false;
  end();
  CHECK(written() <= limits::event::kept);
  CHECK(written() > 0);
}

TEST_CASE_METHOD(log_fixture, "A loop of restarts pushes nothing else out",
                 "[event_log]") {
  listen(ear);
  publish_event("node_joined");
  for (int i = 0; i < 3000; ++i)
    publish_event("instance_changed", "looping");
  // Who listens knows at each moment what is true.
  CHECK(seen.size() == 3001);
  CHECK(seen.back().passing);
  CHECK(state().at("kept") == 1 + limits::event::repetitions);
  time.advance(limits::event::repetition_window);
  CHECK_FALSE(seen.back().passing);
  CHECK(json::parse(seen.back().data).at("more")
        == 3000 - limits::event::repetitions);
  CHECK(json::parse(seen.back().data).at("n") == 1);
}

TEST_CASE_METHOD(log_fixture,
                 "Who comes late to a series hears what is true now",
                 "[event_log]") {
  for (int i = 0; i < 30; ++i)
    publish_event("instance_changed", "looping");
  listen(ear, limits::event::repetitions);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0].passing);
}

TEST_CASE_METHOD(kept_log_fixture, "The past is read from the history",
                 "[event_log]") {
  auto reply = time.ask<kept_events>(log, past_events_query{});
  time.settle();
  REQUIRE((*reply)->value().events.size() == 1);
  CHECK((*reply)->value().events[0].what == "node_lost");
}

} // namespace roscell::test
