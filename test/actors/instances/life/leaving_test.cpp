#include "actors/edge/session/limits.hpp"
#include "actors/instances/limits.hpp"
#include "test/actors/fakes/instance_bench.hpp"

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

struct stop_safe_bench : instance_bench {
  stop_safe_bench() {
    config.row.spec.life.safe_state = true;
  }

  void says(safe_word word) {
    instance_notified words{"i"};
    words.safe = word;
    words.alive = true;
    caf::anon_send(instance, words);
    settle();
  }

  void force() {
    caf::anon_send(instance, stop_instance{"by force", true});
    settle();
  }

  const instance_row& row() const {
    return reported->last();
  }
};

/// A node that its cell may lose, with a step that moves after 60 s.
struct fenced_bench : instance_bench {
  fenced_bench() {
    config.may_be_lost = true;
    config.confirmed = true;
    config.row.spec.life.on_node_loss = {loss_action::move, 60};
    config.row.spec.life.restart.policy = restart_when::on_failure;
    config.contact_boot_ms = boot();
  }

  int64_t boot() {
    return boot_now_ms(system);
  }

  void contact(std::vector<std::string> kept = {}) {
    caf::anon_send(instance, contact_proven{boot(), std::move(kept)});
    settle();
  }

  void lose_contact() {
    caf::anon_send(instance, contact_lost{});
    settle();
  }

  /// Time passes, and the skill says that it is alive.
  void live_on(std::chrono::seconds span) {
    for (auto left = span; left > 0s; left -= 4s) {
      advance(std::min<std::chrono::milliseconds>(left, 4s));
      alive();
    }
  }

  int64_t patience() const {
    return 60'000 - limits::lease::span.count();
  }
};

} // namespace

TEST_CASE("a skill that is not stop-safe is asked, and ended once it is") {
  stop_safe_bench b;
  b.start_ready();
  b.says(safe_word::unsafe);
  b.stop();
  CHECK(b.state() == instance_state::running);
  CHECK(b.row().unsafe_since_unix_ms > 0);
  CHECK(b.row().unsafe_until_unix_ms == 0);
  CHECK(b.runtime->asked_for_safety.size() == 1);
  for (int i = 0; i < 100; ++i) {
    b.advance(5s);
    b.says(safe_word::unsafe);
  }
  CHECK(b.runtime->stopped.empty());
  b.says(safe_word::safe);
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.row().unsafe_since_unix_ms == 0);
}

TEST_CASE("a skill that is stop-safe, or does not run, is not waited for") {
  stop_safe_bench b;
  SECTION("it is stop-safe") {
    b.start_ready();
    b.says(safe_word::safe);
  }
  SECTION("it is not ready yet") {
    b.start();
  }
  SECTION("it backs off") {
    b.config.row.spec.life.restart.policy = restart_when::on_failure;
    b.start_ready();
    b.exits(3);
  }
  b.stop();
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.runtime->asked_for_safety.empty());
}

TEST_CASE("what a skill says with its first word is known once it runs") {
  stop_safe_bench b;
  b.start();
  instance_notified first{"i"};
  first.ready = true;
  first.safe = safe_word::unsafe;
  caf::anon_send(b.instance, first);
  b.settle();
  CHECK(b.state() == instance_state::running);
  CHECK(b.row().safe == safe_word::unsafe);
}

TEST_CASE("what was safe in the run before counts for nothing") {
  stop_safe_bench b;
  b.config.row.spec.life.restart.policy = restart_when::on_failure;
  b.start_ready();
  b.says(safe_word::safe);
  b.exits(3);
  b.advance(2s);
  b.ready();
  b.stop();
  CHECK(b.row().unsafe_since_unix_ms > 0);
}

TEST_CASE("the patience with a skill that is not stop-safe has an end if it "
          "says so") {
  stop_safe_bench b;
  b.config.row.spec.life.safe_timeout_s = 20;
  b.start_ready();
  b.stop();
  CHECK(b.row().unsafe_until_unix_ms - b.row().unsafe_since_unix_ms == 20'000);
  for (int i = 0; i < 19; ++i) {
    b.advance(1s);
    b.alive();
  }
  CHECK(b.runtime->stopped.empty());
  b.advance(2s);
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.reason() == "asked to; it was not stop-safe in time");
}

TEST_CASE("force does not wait for a skill to be stop-safe") {
  stop_safe_bench b;
  b.start_ready();
  SECTION("from the beginning") {
    b.force();
  }
  SECTION("after it was waited for") {
    b.stop();
    b.stop();
    CHECK(b.runtime->asked_for_safety.size() == 1);
    b.force();
  }
  CHECK(b.state() == instance_state::stopped);
}

TEST_CASE("a skill that hangs or ends while it is waited for is gone") {
  stop_safe_bench b;
  b.config.row.spec.life.restart.policy = restart_when::on_failure;
  b.start_ready();
  b.stop();
  SECTION("it hangs") {
    b.advance(limits::instance::watchdog + 1s);
  }
  SECTION("it ends") {
    b.exits(1);
  }
  CHECK(b.state() >= instance_state::stopped);
  CHECK(b.row().unsafe_since_unix_ms == 0);
  b.advance(10min);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a restart of the node goes on waiting for a skill to be stop-safe") {
  stop_safe_bench b;
  b.config.row.unsafe_since_unix_ms = 5;
  b.config.row.reason = "asked to";
  b.adopt_as(instance_state::running, {true, "c1", -1});
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->asked_for_safety.size() == 1);
  CHECK(b.runtime->stopped.empty());
  b.says(safe_word::safe);
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.reason() == "asked to");
}

TEST_CASE("a skill that is to be started again is waited for to be stop-safe") {
  stop_safe_bench b;
  b.config.renewal = "the address of this host has changed";
  b.adopt_as(instance_state::running, {true, "c1", -1});
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->asked_for_safety.size() == 1);
  CHECK(b.row().waits == "waits to be stop-safe");
  CHECK(b.runtime->stopped.empty());
  b.says(safe_word::safe);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reason() == "the address of this host has changed");
  b.advance(1ms);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("one that is not stop-safe in time is started again all the same") {
  stop_safe_bench b;
  b.config.row.spec.life.safe_timeout_s = 5;
  b.config.renewal = "the address of this host has changed";
  b.adopt_as(instance_state::running, {true, "c1", -1});
  b.advance(5s);
  b.advance(1ms);
  CHECK(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a step that may move is fenced from its start on") {
  fenced_bench b;
  b.start_ready();
  REQUIRE(b.runtime->started.size() == 1);
  CHECK(b.runtime->started[0].fence_boot_ms
        == b.config.contact_boot_ms + b.patience());
}

TEST_CASE("each word that has reached the cell moves the fence on") {
  fenced_bench b;
  b.start_ready();
  b.advance(4s);
  b.alive();
  b.contact();
  REQUIRE(b.runtime->fenced.size() == 1);
  CHECK(b.runtime->fenced[0].fence_boot_ms == b.boot() + b.patience());
  CHECK(b.runtime->fenced[0].container == "c1");
}

TEST_CASE("a coordinator that has not asked for it does not move its fence") {
  fenced_bench b;
  b.start_ready();
  b.lose_contact();
  b.advance(1s);
  b.contact({"another"});
  CHECK(b.runtime->fenced.empty());
  b.contact({"i"});
  CHECK(b.runtime->fenced.size() == 1);
}

TEST_CASE("what the fence has ended waits until the cell wants it again") {
  fenced_bench b;
  b.start_ready();
  b.lose_contact();
  b.live_on(52s);
  b.exits(137);
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reported->last().next_start_unix_ms == 0);
  b.advance(10min);
  b.contact();
  CHECK(b.runtime->started.size() == 1);
  b.contact({"i"});
  CHECK(b.runtime->started.size() == 2);
}

TEST_CASE("an orphan starts a step that may move only well before its fence") {
  fenced_bench b;
  b.start_ready();
  b.lose_contact();
  SECTION("nothing has reached the cell for too long") {
    b.live_on(44s);
    b.exits(3);
    b.advance(10min);
    CHECK(b.runtime->started.size() == 1);
  }
  SECTION("something has, a moment ago") {
    b.exits(3);
    b.advance(2s);
    CHECK(b.runtime->started.size() == 2);
  }
}

TEST_CASE("a node that starts again does not start what may run elsewhere") {
  fenced_bench b;
  b.config.confirmed = false;
  b.config.contact_boot_ms = 0;
  b.config.row.next_start_unix_ms = 1;
  b.adopt_as(instance_state::backing_off, {false, "", -1});
  b.advance(10min);
  CHECK(b.runtime->started.empty());
  b.contact({"i"});
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a step that waits for its node has no fence") {
  fenced_bench b;
  b.config.row.spec.life.on_node_loss.policy = loss_action::wait;
  b.start_ready();
  b.contact();
  CHECK(b.runtime->started[0].fence_boot_ms == 0);
  CHECK(b.runtime->fenced.empty());
}

TEST_CASE(
    "a step that may move is asked to be stop-safe when the cell is lost") {
  fenced_bench b;
  b.config.row.spec.life.safe_state = true;
  b.config.row.spec.life.safe_timeout_s = 10;
  b.start_ready();
  b.lose_contact();
  CHECK(b.runtime->asked_for_safety.size() == 1);
  CHECK(b.state() == instance_state::running);
}
