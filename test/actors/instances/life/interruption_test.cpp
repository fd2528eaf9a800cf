#include "test/actors/fakes/instance_bench.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

/// An instance of a node whose host may have been started anew.
struct interrupted_bench : instance_bench {
  interrupted_bench() {
    config.boot = "today";
    config.started_in = "yesterday";
    life().restart.policy = restart_when::on_failure;
  }

  /// It ran, and its container has ended meanwhile.
  void find_ended(int code, bool recorded, bool terminated) {
    adopt_as(instance_state::running,
             {false, "c1", code, recorded, terminated});
  }

  void report_contact(bool kept) {
    caf::anon_send(instance,
                   contact_proven{1, kept ? std::vector<std::string>{"i"}
                                          : std::vector<std::string>{}});
    settle();
  }

  void report_server(const std::string& server) {
    caf::anon_send(instance,
                   use_environment{{{"ROS_DISCOVERY_SERVER", server}}});
    settle();
  }

  bool waits() const {
    const auto& row = reported->last();
    return row.state == instance_state::backing_off && !row.waits.empty()
           && row.interrupted_unix_ms > 0;
  }

  size_t starts() const {
    return runtime->started.size();
  }

  life_policy& life() {
    return config.row.spec.life;
  }
};

} // namespace

TEST_CASE("what another boot has cut off goes on when its cell wants it") {
  interrupted_bench b;
  b.find_ended(-1, false, false);
  CHECK(b.waits());
  CHECK(b.starts() == 0);
  b.advance(24h);
  CHECK(b.starts() == 0);
  b.report_contact(false);
  CHECK(b.starts() == 0);
  b.report_contact(true);
  CHECK(b.starts() == 1);
  b.ready();
  CHECK(b.state() == instance_state::running);
  CHECK(b.reported->last().interrupted_unix_ms == 0);
  CHECK(b.reported->last().waits.empty());
}

TEST_CASE("an orderly shutdown is no end of work, whatever the exit code") {
  interrupted_bench b;
  b.find_ended(GENERATE(0, 1, 143), true, true);
  CHECK(b.waits());
  b.report_contact(true);
  CHECK(b.starts() == 1);
}

TEST_CASE("what ended by itself before the shutdown has ended") {
  interrupted_bench b;
  SECTION("with 0") {
    b.find_ended(0, true, false);
    CHECK(b.state() == instance_state::stopped);
    CHECK(b.reason() == "finished");
  }
  SECTION("with an error, and is not to be started again") {
    b.life().restart.policy = restart_when::never;
    b.find_ended(3, true, false);
    CHECK(b.state() == instance_state::failed);
  }
}

TEST_CASE("a shim that is gone within one boot was killed, as a program is") {
  interrupted_bench b;
  b.config.started_in = "today";
  b.find_ended(-1, false, false);
  CHECK_FALSE(b.waits());
  CHECK(b.reported->last().ends.size() == 1);
  CHECK(b.reported->last().next_start_unix_ms > 0);
}

TEST_CASE("where the boot is not known a missing record is an interruption") {
  interrupted_bench b;
  SECTION("a record of an earlier version") {
    b.config.started_in.clear();
  }
  SECTION("a boot that cannot be read") {
    b.config.started_in.clear();
    b.config.boot.clear();
  }
  b.find_ended(-1, false, false);
  CHECK(b.waits());
}

TEST_CASE("an end that only an engine knows counts, unless the host was off") {
  interrupted_bench b;
  const bool known = GENERATE(false, true);
  if (!known)
    b.config.started_in.clear();
  b.find_ended(0, false, false);
  CHECK(b.waits() == known);
}

TEST_CASE("a program that is told to end from outside comes back by itself") {
  interrupted_bench b;
  b.config.confirmed = true;
  b.start_ready();
  const auto restarts = b.reported->last().restarts;
  caf::anon_send(b.instance, container_exited{"i", "c1", 0, true});
  b.settle();
  CHECK(b.state() == instance_state::backing_off);
  CHECK(b.reported->last().next_start_unix_ms > 0);
  b.advance(1500ms);
  CHECK(b.starts() == 2);
  // It has not failed, so that no bound of failures is counted towards.
  CHECK(b.reported->last().attempts == 0);
  CHECK(b.reported->last().restarts == restarts + 1);
}

TEST_CASE("while the cell is out of reach what is interrupted waits for it") {
  interrupted_bench b;
  b.config.confirmed = true;
  b.start_ready();
  caf::anon_send(b.instance, contact_lost{});
  caf::anon_send(b.instance, container_exited{"i", "c1", 0, true});
  b.settle();
  CHECK(b.waits());
  b.report_contact(true);
  CHECK(b.starts() == 2);
}

TEST_CASE("what was being started when its host went down waits as well") {
  interrupted_bench b;
  b.adopt_as(GENERATE(instance_state::pending, instance_state::building,
                      instance_state::starting),
             {false, "", -1, false, false});
  CHECK(b.waits());
  CHECK(b.starts() == 0);
  b.report_contact(true);
  CHECK(b.starts() == 1);
}

TEST_CASE("what was interrupted is started where its cell is now, and not "
          "before that is known") {
  interrupted_bench b;
  b.config.knows_place = false;
  b.config.row.spec.environment = {{"ROS_DISCOVERY_SERVER", "of yesterday"}};
  SECTION("when its cell wants it") {
    b.find_ended(-1, false, false);
    b.report_contact(true);
  }
  SECTION("when it starts alone") {
    b.life().on_boot = boot_action::start;
    b.find_ended(-1, false, false);
    b.advance(1s);
  }
  CHECK(b.starts() == 0);
  CHECK(b.reported->last().waits == "waits to hear where its cell is");
  b.report_server("of today");
  REQUIRE(b.starts() == 1);
  CHECK(b.runtime->started[0].environment.at("ROS_DISCOVERY_SERVER")
        == "of today");
  CHECK(b.reported->last().waits.empty());
  b.report_server("of today");
  CHECK(b.starts() == 1);
}

TEST_CASE("what is ended while it waits to hear where its cell is stays so") {
  interrupted_bench b;
  b.config.knows_place = false;
  b.find_ended(-1, false, false);
  b.report_contact(true);
  caf::anon_send(b.instance, stop_instance{"removed", false});
  b.settle();
  CHECK(b.state() == instance_state::stopped);
  b.report_server("of today");
  CHECK(b.starts() == 0);
}

TEST_CASE("what goes on and crashes later is started where its cell is then") {
  interrupted_bench b;
  b.config.started_in = b.config.boot;
  b.config.knows_place = false;
  b.config.row.spec.environment = {{"ROS_DISCOVERY_SERVER", "of yesterday"}};
  b.adopt_as(instance_state::running, {true, "c1", -1, false, false});
  CHECK(b.state() == instance_state::running);
  b.report_server("of today");
  CHECK(b.starts() == 0);
  b.exits(1);
  b.advance(5s);
  REQUIRE(b.starts() == 1);
  CHECK(b.runtime->started[0].environment.at("ROS_DISCOVERY_SERVER")
        == "of today");
}

TEST_CASE("a step that starts alone waits for nobody") {
  interrupted_bench b;
  b.life().on_boot = boot_action::start;
  b.find_ended(-1, false, false);
  b.advance(1ms);
  CHECK(b.starts() == 1);
}

TEST_CASE("a step that stays waits for a person, and nothing else starts it") {
  interrupted_bench b;
  SECTION("it says so") {
    b.life().on_boot = boot_action::stay;
  }
  SECTION("it runs once") {
    b.life().restart.policy = restart_when::never;
  }
  SECTION("nobody may find it moving") {
    b.life().safe_state = true;
  }
  b.find_ended(0, true, true);
  CHECK(b.waits());
  CHECK(b.reported->last().waits == "waits for `roscell restart i`");
  b.report_contact(true);
  b.advance(24h);
  CHECK(b.starts() == 0);
  // The restart ends it, for its successor.
  b.stop();
  CHECK(b.state() == instance_state::stopped);
}

TEST_CASE("such a step may say that it goes on") {
  interrupted_bench b;
  b.life().safe_state = true;
  b.life().on_boot = boot_action::rejoin;
  b.find_ended(0, true, true);
  b.report_contact(true);
  CHECK(b.starts() == 1);
}

TEST_CASE("what was to go when it was interrupted has gone") {
  interrupted_bench b;
  b.config.row.unsafe_since_unix_ms = 5;
  b.config.row.reason = "removed";
  b.find_ended(0, true, true);
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.reason() == "removed");
}

TEST_CASE("a node that is started again meanwhile lets it wait on") {
  interrupted_bench b;
  b.config.row.interrupted_unix_ms = 5;
  b.config.row.reason = "it was interrupted";
  b.adopt_as(instance_state::backing_off, {false, "", -1, false, false});
  CHECK(b.waits());
  CHECK(b.starts() == 0);
  b.report_contact(true);
  CHECK(b.starts() == 1);
}

TEST_CASE("the boot in which a program was started stands in its record") {
  interrupted_bench b;
  b.start_ready();
  const auto record = json::parse(b.store->records.back().value);
  CHECK(record.at("boot") == "today");
}
