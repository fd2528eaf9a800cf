#include "actors/edge/session/limits.hpp"
#include "test/actors/fakes/cell_fakes.hpp"

#include <algorithm>

/// What a node does when it loses its coordinator.
namespace {

using namespace roscell;
using namespace roscell::test;

using orphan_test = cell_fixture;

TEST_CASE_METHOD(orphan_test, "a killed coordinator orphans its members at "
                              "once and gets them back") {
  form_cell();
  site.pass(20s);
  site.kill_coordinator();
  site.pass(0s);
  auto status = site.status(node);
  CHECK(status.state == node_state::orphaned);
  CHECK(status.cell == "cell-1");
  CHECK_FALSE(node.searching);
  REQUIRE(site.count("coordinator_lost") == 1);
  site.pass(20s);
  site.start_coordinator();
  site.pass(15s);
  status = site.status(node);
  CHECK(status.state == node_state::member);
  CHECK(site.count("cell_joined") == 2);
  CHECK(site.base.rows.at("arm-1").registration.incarnation == 2);
}

TEST_CASE_METHOD(orphan_test, "a coordinator that restarts at once has its "
                              "members back within a second") {
  form_cell();
  site.pass(20s);
  site.kill_coordinator();
  site.start_coordinator();
  site.pass(1s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(orphan_test, "a silent coordinator is lost within a "
                              "lease") {
  form_cell();
  site.pass(21s);
  node.link->silent = true;
  node.refusal = {error_code::unreachable, "no route to host"};
  site.pass(limits::lease::span - limits::lease::heartbeat_period - 1s);
  CHECK(state() == node_state::member);
  site.pass(limits::lease::heartbeat_period + 1s);
  CHECK(state() == node_state::orphaned);
  const auto& events = site.events;
  const auto lost =
      std::find_if(events.begin(), events.end(),
                   [](const auto& x) { return x.what == "coordinator_lost"; });
  REQUIRE(lost != events.end());
  CHECK(lost->data["reason"] == "no heartbeat for 8 s");
}

TEST_CASE_METHOD(orphan_test, "an orphan claims its address whenever it looks "
                              "for its cell, and nobody else does") {
  form_cell();
  site.pass(20s);
  CHECK(node.claims == 0);
  site.kill_coordinator();
  site.pass(20s);
  CHECK(node.claims > 1);
  site.start_coordinator();
  site.pass(15s);
  const auto claims = node.claims;
  site.pass(60s);
  CHECK(node.claims == claims);
}

/// What the coordinator of the member says at another address.
node_presence seen_elsewhere(int64_t incarnation) {
  node_presence result;
  result.role = "coordinator";
  result.name = "base";
  result.uuid = "b-1";
  result.incarnation = incarnation;
  result.cell = "cell-1";
  result.address = "10.0.0.7:8420";
  result.discovery_server = "10.0.0.7:11811";
  return result;
}

struct moved_test : cell_fixture {
  /// Why the coordinator is lost that says this again and again.
  std::string loss_by(const node_presence& said) {
    const auto lost = [&] { return site.count("coordinator_lost") > 0; };
    for (auto i = 0; i < 40 && !lost(); ++i) {
      caf::anon_send(node.membership, presence_seen{said});
      site.pass(250ms);
    }
    for (const auto& x : site.events)
      if (x.what == "coordinator_lost")
        return x.data["reason"];
    return "";
  }
};

TEST_CASE_METHOD(moved_test,
                 "a silent coordinator that has begun anew elsewhere "
                 "is sought there before its lease is over") {
  form_cell();
  site.pass(21s);
  // As long as it is heard that may be anybody's word.
  CHECK(loss_by(seen_elsewhere(2)).empty());
  node.link->silent = true;
  CHECK(loss_by(seen_elsewhere(2))
        == "the coordinator has started again at 10.0.0.7:8420");
  site.pass(1s);
  CHECK(node.sought.back() == "10.0.0.7:11811");
}

TEST_CASE_METHOD(moved_test, "an earlier life of a silent coordinator is not "
                             "sought") {
  form_cell();
  site.pass(21s);
  node.link->silent = true;
  CHECK(loss_by(seen_elsewhere(1)) == "no heartbeat for 8 s");
}

TEST_CASE_METHOD(orphan_test, "whoever announces an orphan's cell elsewhere "
                              "does not keep it from coming back") {
  form_cell();
  site.pass(20s);
  site.kill_coordinator();
  site.pass(1s);
  REQUIRE(state() == node_state::orphaned);
  site.unauthenticated_server = "10.0.0.7:11811";
  // A new one each time, ten times a second.
  int64_t said = 100;
  const auto announce_for = [&](std::chrono::seconds span) {
    const auto end = site.now() + span;
    while (site.now() < end && state() != node_state::member) {
      caf::anon_send(node.membership, presence_seen{seen_elsewhere(said++)});
      site.pass(100ms);
    }
  };
  announce_for(5s);
  CHECK(std::count(node.sought.begin(), node.sought.end(), "10.0.0.7:11811")
        > 0);
  site.start_coordinator();
  announce_for(20s);
  CHECK(state() == node_state::member);
}

TEST_CASE_METHOD(orphan_test, "an orphan does not join another cell that "
                              "has taken its server's place") {
  form_cell();
  site.kill_coordinator();
  site.base.cell = "cell-2";
  site.start_coordinator();
  site.pass(20s);
  CHECK(state() == node_state::orphaned);
  CHECK(site.count("join_refused") == 1);
  CHECK(site.base.rows.empty());
}

TEST_CASE_METHOD(orphan_test, "an older incarnation is ignored and a newer "
                              "one is joined") {
  site.base.incarnation = 5;
  form_cell();
  const auto link = node.link;
  caf::anon_send(node.membership,
                 coordinator_found{"cell-1", "base", "10.0.0.1:8420", 4});
  site.pass(1s);
  CHECK(node.link == link);
  CHECK(state() == node_state::member);
  site.base.incarnation = 6;
  site.announce_to(node);
  site.pass(2s);
  CHECK(node.link != link);
  CHECK(state() == node_state::member);
  CHECK(site.base.rows.at("arm-1").registration.incarnation == 6);
}

TEST_CASE_METHOD(orphan_test, "a coordinator that has lost its records is "
                              "joined when no newer one is found") {
  site.base.incarnation = 5;
  form_cell();
  site.kill_coordinator();
  site.base.incarnation = 1;
  site.start_coordinator();
  site.pass(4s);
  CHECK(state() == node_state::orphaned);
  site.pass(4s);
  CHECK(state() == node_state::member);
}

} // namespace
