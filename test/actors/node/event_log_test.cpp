#include "actors/house/limits.hpp"
#include "actors/node/event_log.hpp"
#include "test/fixture.hpp"

namespace roscell::test {

namespace {

caf::behavior listener(caf::event_based_actor*, std::vector<event>* seen) {
  return {[=](const event& x) { seen->push_back(x); }};
}

struct log_fixture {
  virtual_time time;
  event_log_actor log = spawn(time.system, time.context, event_log);
  std::vector<event> seen;
  caf::actor ear = time.system.spawn(listener, &seen);

  ~log_fixture() {
    time.kill(ear);
    time.kill(log);
  }

  void tell(const std::string& what) {
    house{nullptr, log}.tell(what, "arm", {{"n", 1}});
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

TEST_CASE_METHOD(log_fixture, "Facts are numbered from 1 without a gap",
                 "[event_log]") {
  listen(ear);
  for (int i = 0; i < 5; ++i)
    tell("node_joined");
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
    tell(what);
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
    tell("node_joined");
  listen(ear, 3);
  tell("node_left");
  REQUIRE(seen.size() == 3);
  CHECK(seen[0].sequence == 4);
  CHECK(seen[1].sequence == 5);
  CHECK(seen[2].what == "node_left");
}

TEST_CASE_METHOD(log_fixture, "The newest 1000 facts are kept", "[event_log]") {
  for (int i = 0; i < 1200; ++i)
    tell("node_joined");
  CHECK(state().at("kept") == 1000);
  listen(ear);
  REQUIRE(seen.size() == 1000);
  CHECK(seen.front().sequence == 201);
  CHECK(seen.back().sequence == 1200);
}

TEST_CASE_METHOD(log_fixture, "Refusals without end leave room for other facts",
                 "[event_log]") {
  listen(ear);
  tell("node_joined");
  for (int i = 0; i < 1300; ++i)
    tell("session_refused");
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
  tell("node_joined");
  CHECK(seen.empty());
}

TEST_CASE_METHOD(log_fixture,
                 "A listener that is dead when it subscribes is forgotten",
                 "[event_log]") {
  time.kill(ear);
  listen(ear);
  CHECK(state().at("listeners") == 0);
}

TEST_CASE_METHOD(log_fixture, "Without a log, facts go nowhere",
                 "[event_log]") {
  house{nullptr, {}}.tell("node_joined", "arm");
  CHECK(state().at("last_sequence") == 0);
}

} // namespace roscell::test
