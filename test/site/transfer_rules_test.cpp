#include "test/site/watch/site_watch.hpp"

#include <algorithm>
#include <optional>

/// What operators and other cells are told of a transfer that does not go as it
/// should.
namespace {

using namespace roscell;
using namespace roscell::test;

/// Two cells that know each other, and a node in the first one.
struct transfer_site {
  virtual_time clock;
  site place{clock, 1};
  site_party& from = place.add_coordinator("c-0");
  site_party& to = place.add_coordinator("c-1");
  site_party& node = place.add_node(from.discovery_server);

  transfer_site() {
    for (auto& x : place.parties)
      place.start(*x);
    place.pass(20s);
    REQUIRE(complaint(place).empty());
  }

  size_t transfer(const site_party& asked) {
    place.ask<node_transferred>(asked, node_transfer{node.name, to.cell});
    return place.requests.size() - 1;
  }

  std::optional<error_code> code(size_t request) const {
    const auto why = place.requests[request].refusal();
    return why ? std::optional{why->code} : std::nullopt;
  }

  size_t count(const std::string& what, const site_party& who) const {
    return static_cast<size_t>(std::count_if(
        place.events.begin(), place.events.end(),
        [&](const auto& x) { return x.what == what && x.party == who.index; }));
  }
};

TEST_CASE("of two who want to move a node the second one gets a conflict",
          "[transfer]") {
  transfer_site x;
  const auto first = x.transfer(x.from);
  const auto second = x.transfer(x.from);
  x.place.pass(20s);
  REQUIRE(x.place.requests[second].is_answered());
  const auto why = x.place.requests[second].refusal();
  REQUIRE(why);
  CHECK(why->code == error_code::conflict);
  CHECK(why->hint.find(x.from.cell + "-1-1") != std::string::npos);
  CHECK(x.place.requests[first].is_answered());
  CHECK_FALSE(x.code(first));
  CHECK(x.node.status().cell == x.to.cell);
}

TEST_CASE(
    "a transfer of which nothing is heard is unresolved, and settled when "
    "the cells meet",
    "[transfer]") {
  transfer_site x;
  // The node gets its order, and then its old cell hears nothing any more.
  const auto request = x.transfer(x.from);
  x.place.pass_until(5s,
                     [&] { return x.count("switch_accepted", x.node) > 0; });
  x.place.split({0, 1, 1});
  x.place.pass(20s);
  CHECK_FALSE(x.place.requests[request].is_answered());
  CHECK(x.node.status().cell == x.to.cell);
  x.place.pass(10s);
  CHECK(x.code(request) == error_code::unresolved);
  CHECK(x.count("node_lost", x.from) == 1);
  x.place.heal_all();
  x.place.pass(60s);
  CHECK(x.count("transfer_ended", x.from) == 1);
  CHECK(complaint(x.place).empty());
}

TEST_CASE("a node whose new cell cannot be reached comes back", "[transfer]") {
  transfer_site x;
  // The two coordinators hear each other, the node and its new one do not.
  x.place.block(x.node.index, x.to.index);
  const auto request = x.transfer(x.from);
  x.place.pass(40s);
  CHECK(x.code(request) == error_code::unreachable);
  CHECK(x.node.status().cell == x.from.cell);
  CHECK(complaint(x.place).empty());
}

TEST_CASE("a session that does not know whether its node goes is ended",
          "[transfer]") {
  transfer_site x;
  const auto lost = x.count("coordinator_lost", x.node);
  // The order arrives, and the answer does not.
  x.place.judge = [&](const site_message& m) {
    const bool answer = m.from == x.node.index
                        && x.count("switch_accepted", x.node) > 0
                        && m.to == x.from.index;
    return answer ? frame_fate::lost : frame_fate::passed;
  };
  const auto request = x.transfer(x.from);
  x.place.pass(60s);
  CHECK(x.count("coordinator_lost", x.node) == lost);
  CHECK(x.place.requests[request].is_answered());
  x.place.judge = nullptr;
  CHECK(x.node.status().cell == x.to.cell);
  CHECK(calm_down(x.place).empty());
}

TEST_CASE("any coordinator is asked to move a node, and hears the outcome",
          "[transfer]") {
  transfer_site x;
  const auto request = x.transfer(x.to);
  x.place.pass(20s);
  CHECK(x.place.requests[request].is_answered());
  CHECK_FALSE(x.code(request));
  CHECK(x.node.status().cell == x.to.cell);
}

TEST_CASE("two cells that are cut apart go on and compare their rows later",
          "[transfer]") {
  transfer_site x;
  x.place.split({0, 1, 0});
  x.place.pass(30s);
  CHECK(x.count("peer_lost", x.from) == 1);
  CHECK(x.count("peer_lost", x.to) == 1);
  CHECK(x.node.status().state == node_state::member);
  x.place.heal_all();
  x.place.pass(60s);
  CHECK(complaint(x.place).empty());
}

} // namespace
