#include "messages/failure.hpp"
#include "test/site/watch/site_watch.hpp"

#include <algorithm>

/// How coordinators let members go when names, disks or nodes fail them.
namespace {

using namespace roscell;
using namespace roscell::test;

template <class Reply>
using site_reply = std::shared_ptr<std::optional<caf::expected<Reply>>>;

template <class Reply>
failure why_not(const site_reply<Reply>& reply) {
  REQUIRE(*reply);
  REQUIRE_FALSE(**reply);
  return to_failure((*reply)->error());
}

/// Two cells, each with a member.
struct two_cells {
  virtual_time clock;
  site place{clock, 1};
  site_party& left = place.add_coordinator("c-0");
  site_party& right = place.add_coordinator("c-1");
  site_party& arm = place.add_node(left.discovery_server);
  site_party& leg = place.add_node(right.discovery_server);

  void begin() {
    for (auto& x : place.parties)
      place.start(*x);
    place.pass(20s);
    REQUIRE(complaint(place).empty());
    REQUIRE(arm.status().cell == left.cell);
    REQUIRE(leg.status().cell == right.cell);
  }

  site_reply<node_released> release(site_party& whom, const std::string& node,
                                    const std::string& cell = "") {
    node_release request;
    request.node = node;
    request.cell = cell;
    return clock.ask<node_released>(whom.coordinator, request);
  }

  registry_entry* row_of(site_party& cell, const site_party& node) {
    return cell.cell_state().registry.find_uuid(node.uuid);
  }

  /// The order to go is lost on its way to the node, or its answer is.
  void drop_next_frame_to(const site_party& node) {
    place.judge = [this, &node, lost = false](const site_message& x) mutable {
      if (lost || x.to != node.index || std::string{x.what} != "frame")
        return frame_fate::passed;
      lost = true;
      return frame_fate::lost;
    };
  }
};

// -- names -------------------------------------------------------------------

TEST_CASE("a release that is sent twice takes no other cell's namesake",
          "[letting_go]") {
  two_cells x;
  x.leg.name = x.arm.name;
  x.begin();
  const auto first = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  REQUIRE(*first);
  CHECK(**first);
  const auto second = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  const auto why = why_not(second);
  CHECK(why.code == error_code::unknown_node);
  CHECK(why.message.find((*first)->value().transfer) != std::string::npos);
  CHECK(why.hint.find("\"cell\"") != std::string::npos);
  CHECK(x.leg.status().state == node_state::member);
  const auto named = x.release(x.left, x.arm.name, x.right.cell);
  x.place.pass(5s);
  REQUIRE(*named);
  CHECK(**named);
  CHECK(x.leg.status().state == node_state::independent);
}

TEST_CASE("a node of another cell is released if it is the only one",
          "[letting_go]") {
  two_cells x;
  x.begin();
  const auto reply = x.release(x.left, x.leg.name);
  x.place.pass(5s);
  REQUIRE(*reply);
  REQUIRE(**reply);
  CHECK((*reply)->value().cell == x.right.cell);
}

TEST_CASE("a name that several other cells have is not guessed",
          "[letting_go]") {
  two_cells x;
  x.leg.name = x.arm.name;
  auto& third = x.place.add_coordinator("c-2");
  x.begin();
  const auto why = [&] {
    const auto reply = x.release(third, x.arm.name);
    x.place.pass(5s);
    return why_not(reply);
  }();
  CHECK(why.code == error_code::conflict);
  CHECK(why.message.find(x.left.cell) != std::string::npos);
  CHECK(why.message.find(x.right.cell) != std::string::npos);
  CHECK(complaint(x.place).empty());
}

// -- disks -------------------------------------------------------------------

TEST_CASE("a transfer that cannot be written down changes nothing",
          "[letting_go]") {
  two_cells x;
  x.begin();
  x.left.disk_full = true;
  const auto refused = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  CHECK(why_not(refused).message.find("disk is full") != std::string::npos);
  CHECK(x.row_of(x.left, x.arm)->row.state == row_state::active);
  CHECK(x.left.cell_state().transfers.rows().empty());
  CHECK(x.place.count("node_departing") == 0);
  x.left.disk_full = false;
  const auto done = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  REQUIRE(*done);
  CHECK(**done);
}

TEST_CASE("transfers that have ended are known after a restart",
          "[letting_go]") {
  two_cells x;
  x.begin();
  const auto reply = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  REQUIRE(**reply);
  x.place.kill(x.left);
  x.place.start(x.left);
  x.place.pass(20s);
  const auto* gone = x.left.cell_state().transfers.find_gone(x.arm.name);
  REQUIRE(gone);
  CHECK(gone->transfer == (*reply)->value().transfer);
}

// -- nodes -------------------------------------------------------------------

/// The node dies just when it has been told to go.
void die_while_switching(two_cells& x) {
  x.place.judge = [&](const site_message& m) {
    const bool is_order = m.to == x.arm.index && std::string{m.what} == "frame";
    return is_order ? frame_fate::lost : frame_fate::passed;
  };
  const auto reply = x.release(x.left, x.arm.name);
  x.place.pass(1s);
  x.place.judge = nullptr;
  x.place.kill(x.arm);
  x.place.pass(40s);
  CHECK(why_not(reply).code == error_code::unresolved);
}

TEST_CASE("a node that died while it switched can be released",
          "[letting_go]") {
  two_cells x;
  x.begin();
  die_while_switching(x);
  REQUIRE(x.row_of(x.left, x.arm));
  CHECK(x.row_of(x.left, x.arm)->row.state == row_state::lost);
  const auto again = x.release(x.left, x.arm.name);
  x.place.pass(5s);
  REQUIRE(*again);
  CHECK(**again);
  CHECK_FALSE(x.row_of(x.left, x.arm));
  const auto rows = x.left.cell_state().transfers.rows();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].state == transfer_state::returned);
  CHECK(rows[1].state == transfer_state::done);
}

TEST_CASE("a node that died while it switched keeps no name from another",
          "[letting_go]") {
  two_cells x;
  x.begin();
  die_while_switching(x);
  auto& successor = x.place.add_node(x.left.discovery_server);
  successor.name = x.arm.name;
  x.place.start(successor);
  x.place.pass(40s);
  CHECK(successor.status().cell == x.left.cell);
}

TEST_CASE("a node that leaves while a switch is written down goes nowhere",
          "[letting_go]") {
  two_cells x;
  x.begin();
  x.place.judge = [&](const site_message& m) {
    const bool held = m.from == x.arm.index && std::string{m.what} == "write";
    return held ? frame_fate::late : frame_fate::passed;
  };
  const auto reply = x.clock.ask<node_transferred>(
      x.left.coordinator, node_transfer{x.arm.name, x.right.cell});
  x.place.pass(500ms);
  REQUIRE(x.arm.status().phase == membership_phase::accepting);
  x.clock.ask<node_departed>(x.arm.membership, leave_cell{"it is shut down"});
  x.place.pass(500ms);
  x.place.judge = nullptr;
  x.place.pass(20s);
  CHECK(x.arm.status().state == node_state::independent);
  CHECK(x.arm.status().cell.empty());
  CHECK(x.place.count("switch_accepted") == 0);
}

} // namespace
