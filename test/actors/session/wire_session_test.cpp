#include "actors/edge/session/limits.hpp"
#include "actors/session/limits.hpp"
#include "actors/session/wire_session.hpp"

#include "test/fixture.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <string>
#include <utility>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

/// Links that carry nothing anywhere.
struct dead_link : session_link {
  void start(session_callbacks) override {}
  bool send(std::string) override {
    return true;
  }
  void close(std::string) override {}
  size_t queued_bytes() const override {
    return 0;
  }
};

struct dead_heartbeats : heartbeat_link {
  void send(heartbeat_kind, uint32_t) override {}
};

/// A session with arm, from which no heartbeat comes back.
struct silent_session {
  virtual_time time;
  std::shared_ptr<metric_table> metrics = std::make_shared<metric_table>();
  session_actor session;

  silent_session() {
    auto wire = std::make_shared<session_wire>();
    wire->link = std::make_shared<dead_link>();
    wire->heartbeats = std::make_unique<dead_heartbeats>();
    auto context = time.context;
    context.metrics = metrics;
    session = spawn(time.system, context, wire_session, context, wire, "arm");
  }

  void heartbeat() {
    caf::anon_send(session, send_heartbeat{heartbeat_kind::heartbeat, 0});
    time.settle();
  }

  void end() {
    caf::anon_send(std::exchange(session, nullptr), close_session{"silent"});
    time.settle();
  }

  double lost() const {
    const auto samples = metrics->samples(metric::heartbeats_lost);
    return samples.empty() ? 0 : samples.at(0).sum;
  }
};

} // namespace

TEST_CASE_METHOD(silent_session,
                 "heartbeats that nobody answered before the end are lost",
                 "[session][metrics]") {
  heartbeat();
  time.advance(limits::lease::heartbeat_period);
  heartbeat();
  time.advance(limits::lease::probe_interval + 1ms);
  CHECK(lost() == 0);
  // Its answer may be on its way.
  heartbeat();
  end();
  CHECK(lost() == 2);
}

TEST_CASE_METHOD(silent_session, "heartbeats too old to be remembered are lost",
                 "[session][metrics]") {
  for (size_t i = 0; i < limits::session::remembered_heartbeats + 3; ++i)
    heartbeat();
  CHECK(lost() == 3);
  end();
}

} // namespace roscell::test
