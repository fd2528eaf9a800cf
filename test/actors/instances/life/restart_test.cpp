#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"
#include "test/actors/fakes/instance_bench.hpp"

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

struct restart_bench : instance_bench {
  restart_bench() {
    policy().policy = restart_when::on_failure;
  }

  restart_policy& policy() {
    return config.row.spec.life.restart;
  }

  /// Crashes, and tells how long it is until it is started again.
  std::chrono::milliseconds pause_after_crash() {
    const auto before = runtime->started.size();
    exits(3, runtime->container());
    std::chrono::milliseconds result{0};
    while (runtime->started.size() == before && result < 1h) {
      advance(50ms);
      result += 50ms;
    }
    return result;
  }
};

} // namespace

TEST_CASE("what has run and fails is started again after a pause") {
  restart_bench b;
  b.start_ready();
  b.exits(3);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "it ended with exit code 3");
  CHECK(b.reported->last().next_start_unix_ms > 0);
  b.advance(900ms);
  CHECK(b.runtime->started.size() == 1);
  b.advance(300ms);
  REQUIRE(b.runtime->started.size() == 2);
  // What the last run has left is gone before.
  CHECK(b.runtime->removed.size() == 1);
  b.ready();
  CHECK(b.state() == instance_state::running);
  CHECK(b.reported->last().restarts == 1);
  CHECK(b.reported->last().next_start_unix_ms == 0);
  REQUIRE(b.reported->last().ends.size() == 1);
  CHECK(b.reported->last().ends[0].exit_code == 3);
  CHECK(b.reported->last().ends[0].log == "first line\nlast line");
}

TEST_CASE("a new start after a short pause is written down once") {
  restart_bench b;
  b.policy().delay_s = 11;
  b.start_ready();
  const auto before = b.store->states("i").size();
  REQUIRE(b.store->states("i").back() == "running");
  b.pause_after_crash();
  CHECK(b.store->states("i").size() == before);
  b.ready();
  CHECK(b.store->states("i").size() == before + 1);
  CHECK(b.store->states("i").back() == "running");
  CHECK(json::parse(b.store->records.back().value).at("restarts") == 1);
}

TEST_CASE("new starts one soon after the other are written down once") {
  restart_bench b;
  b.policy().max_delay_s = 1;
  b.start_ready();
  const auto before = b.store->states("i").size();
  for (int i = 0; i < 20; ++i) {
    b.pause_after_crash();
    b.ready();
  }
  const auto written = b.store->states("i").size() - before;
  CHECK(written >= 1);
  CHECK(written <= 3);
  CHECK(b.reported->last().restarts == 20);
}

TEST_CASE("an end is told with the words of its own run") {
  restart_bench b;
  b.runtime->log = "of before\n[shim: started again]\nlast words\n";
  b.start_ready();
  b.exits(3);
  REQUIRE(b.reported->last().ends.size() == 1);
  CHECK(b.reported->last().ends[0].log == "last words");
}

TEST_CASE("a pause that a restarted node could not guess is written down") {
  restart_bench b;
  SECTION("it is long") {
    b.policy().delay_s = 100;
    b.start_ready();
    b.exits(3);
  }
  SECTION("the node has ended the program itself") {
    b.start_ready();
    b.advance(limits::instance::watchdog + 1s);
  }
  REQUIRE(b.state() == instance_state::backing_off);
  CHECK(b.store->states("i").back() == "backing_off");
}

TEST_CASE("what is ready and dies at once is not started ever faster") {
  restart_bench b;
  b.policy().max_delay_s = 8;
  b.start_ready();
  for (const std::chrono::milliseconds wanted : {1s, 2s, 4s, 8s, 8s}) {
    const auto pause = b.pause_after_crash();
    CHECK(pause >= wanted);
    CHECK(pause <= wanted * 11 / 10 + 100ms);
    b.ready();
  }
}

TEST_CASE("a run that is long enough begins the pauses anew") {
  restart_bench b;
  b.policy().reset_after_s = 5;
  b.start_ready();
  b.pause_after_crash();
  b.ready();
  CHECK(b.pause_after_crash() >= 2s);
  b.ready();
  b.advance(6s);
  CHECK(b.pause_after_crash() <= 1200ms);
}

TEST_CASE("what has never been ready fails its deployment") {
  restart_bench b;
  b.start();
  b.exits(3);
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE("a new start that comes to nothing is tried again, too") {
  restart_bench b;
  b.start_ready();
  b.exits(3);
  b.runtime->start_error = fail(error_code::engine_failed, "no such file");
  b.advance(1200ms);
  CHECK(b.state() == instance_state::backing_off);
  b.runtime->start_error = {};
  b.advance(3s);
  b.ready();
  CHECK(b.state() == instance_state::running);
  CHECK(b.reported->last().restarts == 2);
}

TEST_CASE("after the last attempt it has failed, and says how often") {
  restart_bench b;
  b.policy().max_attempts = 2;
  b.start_ready();
  b.pause_after_crash();
  b.ready();
  b.pause_after_crash();
  b.ready();
  b.exits(3, b.runtime->container());
  CHECK(b.state() == instance_state::failed);
  CHECK(b.reason() == "it ended with exit code 3, after 2 new starts in a row");
}

TEST_CASE("what hangs is ended by force and started again") {
  restart_bench b;
  b.start_ready();
  b.advance(limits::instance::watchdog + 1s);
  CHECK(b.state() == instance_state::backing_off);
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->stopped[0].grace_ms == 0);
}

TEST_CASE("what may not have ended is not started a second time") {
  restart_bench b;
  b.start_ready();
  b.runtime->stop_error = fail(error_code::engine_failed, "it is a zombie");
  b.advance(limits::instance::watchdog + 1s);
  CHECK(b.state() == instance_state::failed);
  b.advance(10min);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a stop ends a pause") {
  restart_bench b;
  b.start_ready();
  b.exits(3);
  b.stop();
  CHECK(b.state() == instance_state::stopped);
  b.advance(10min);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a stop while it is being ended for a failure is the end") {
  restart_bench b;
  b.start_ready();
  b.runtime->stops_never = true;
  b.advance(limits::instance::watchdog + 1s);
  REQUIRE(b.state() == instance_state::stopping);
  b.stop();
  b.advance(limits::instance::stop + 1s);
  CHECK(b.state() == instance_state::failed);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a restart of the node keeps attempts and the rest of the pause") {
  restart_bench b;
  b.config.row.attempts = 4;
  b.config.row.restarts = 6;
  b.config.row.reason = "it ended with exit code 3";
  // The clock of the records stands still here, so all of a pause is left.
  b.config.row.next_start_unix_ms = 9'000'000'000'000;
  b.policy().max_delay_s = 10;
  b.adopt_as(instance_state::backing_off, {false, "", -1});
  CHECK(b.state() == instance_state::backing_off);
  b.advance(10s);
  CHECK(b.runtime->started.empty());
  b.advance(2s);
  CHECK(b.runtime->started.size() == 1);
  b.ready();
  CHECK(b.reported->last().restarts == 7);
  CHECK(b.reported->last().attempts == 5);
}

TEST_CASE("what ended while the node was away is started again") {
  restart_bench b;
  b.adopt_as(instance_state::running, {false, "c1", 5});
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "it ended with exit code 5 while the node was away");
  b.advance(1200ms);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("what has finished is started again only if it always is") {
  restart_bench b;
  SECTION("on failure: it stays as it is") {
    b.start_ready();
    b.exits(0);
    CHECK(b.state() == instance_state::stopped);
  }
  SECTION("always") {
    b.policy().policy = restart_when::always;
    b.start_ready();
    b.exits(0);
    CHECK(b.state() == instance_state::backing_off);
  }
}

TEST_CASE("what was started at an address that is gone is started again") {
  restart_bench b;
  b.policy().policy = restart_when::never;
  b.config.address = "10.0.0.9";
  b.config.started_at = "10.0.0.5";
  b.config.renewal = "the address of this host has changed";
  const auto state =
      GENERATE(instance_state::starting, instance_state::running);
  b.adopt_as(state, {true, "c1", -1});
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "the address of this host has changed");
  b.advance(1ms);
  REQUIRE(b.runtime->started.size() == 1);
  b.ready();
  CHECK(b.state() == instance_state::running);
  REQUIRE(b.reported->last().ends.size() == 1);
  CHECK(b.reported->last().ends[0].reason
        == "the address of this host has changed");
  // Once, and it is written down where it is now.
  CHECK(json::parse(b.store->records.back().value).at("address") == "10.0.0.9");
  b.exits(0, b.runtime->container());
  CHECK(b.state() == instance_state::stopped);
}
