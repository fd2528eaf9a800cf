#include "actors/edge/session/limits.hpp"
#include "test/actors/fakes/cell_fakes.hpp"

/// Events that do not fit into a frame of a session.
namespace {

using namespace roscell;
using namespace roscell::test;

using large_events_test = cell_fixture;

/// A change of an instance whose specification alone fills a frame.
instance_changed large_change() {
  instance_changed result{some_row("t-a-1", "t")};
  auto& row = result.instance;
  row.state = instance_state::failed;
  row.exit_code = 3;
  row.reason = "the arm is stuck";
  row.log_tail = "the last words";
  row.spec.parameters =
      json{{"map", std::string(limits::session::frame_bytes, 'x')}}.dump();
  return result;
}

} // namespace

TEST_CASE_METHOD(large_events_test,
                 "a coordinator hears how an instance is, however much is to "
                 "be said of it") {
  form_cell();
  caf::anon_send(node.membership, large_change());
  site.pass(1ms);
  REQUIRE(site.base.changes.size() == 1);
  const auto& heard = site.base.changes[0].instance;
  CHECK(heard.spec.instance == "t-a-1");
  CHECK(heard.state == instance_state::failed);
  CHECK(heard.exit_code == 3);
  CHECK(heard.reason == "the arm is stuck");
  CHECK(heard.spec.parameters.size() < 100);
  CHECK(site.count("fact_too_large") == 0);
}

TEST_CASE_METHOD(large_events_test,
                 "an event that does not fit into a frame at all is told of") {
  form_cell();
  auto change = large_change();
  change.instance.reason.assign(2 * limits::session::frame_bytes, 'x');
  caf::anon_send(node.membership, change);
  site.pass(1ms);
  CHECK(site.base.changes.empty());
  REQUIRE(site.count("fact_too_large") == 1);
  CHECK(site.events.back().data["instance"] == "t-a-1");
  CHECK(site.events.back().data["state"] == "failed");
}
