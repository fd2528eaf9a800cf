#include "actors/edge/session/proofs.hpp"
#include "actors/session/registration_client.hpp"
#include "messages/failure.hpp"
#include "test/site/watch/site_watch.hpp"

#include <algorithm>

/// What the numbers in messages are for: whatever is overtaken changes nothing.
namespace {

using namespace roscell;
using namespace roscell::test;

TEST_CASE("a registration that a later one has overtaken changes nothing",
          "[epoch]") {
  virtual_time clock;
  site place{clock, 1};
  auto& base = place.add_coordinator("c-0");
  auto& node = place.add_node(base.discovery_server);
  // The node gives up and registers anew before it arrives.
  place.faults.late_by = 6s;
  bool held = false;
  place.judge = [&](const site_message& x) {
    const bool first = std::string{x.what} == "frame" && x.from == node.index
                       && !std::exchange(held, true);
    return first ? frame_fate::late : frame_fate::passed;
  };
  place.start(base);
  place.start(node);
  place.pass(20s);
  CHECK(held);
  CHECK(place.count("cell_joined") == 1);
  CHECK(place.count("node_joined") == 1);
  CHECK(place.count("coordinator_lost") == 0);
  CHECK(complaint(place).empty());
}

TEST_CASE(
    "of two cells that claim a node the one with the newer epoch is right",
    "[epoch]") {
  virtual_time clock;
  site place{clock, 1};
  auto& base = place.add_coordinator("c-0");
  auto& other = place.add_coordinator("c-1");
  auto& node = place.add_node(base.discovery_server);
  place.start(base);
  place.start(other);
  place.start(node);
  place.pass(20s);
  REQUIRE(complaint(place).empty());
  const auto joined = place.count("cell_joined");
  const auto claim = [&](int64_t epoch) {
    const auto& peer = base.cell_state().peers.find(other.uuid)->actor;
    caf::anon_send(
        base.coordinator,
        peer_changed{peer, {2, {{node.name, node.uuid, epoch, true}}, {}}});
    place.pass(1s);
  };
  const auto epoch = node.status().config.identity.epoch;
  claim(epoch - 1);
  CHECK(place.count("node_left") == 0);
  CHECK(place.count("coordinator_lost") == 0);
  CHECK(place.count("cell_joined") == joined);
  claim(epoch + 1);
  CHECK(place.count("node_left") == 1);
  CHECK(place.count("coordinator_lost") == 1);
}

TEST_CASE("an order for an earlier epoch of a node is refused", "[epoch]") {
  virtual_time clock;
  site place{clock, 1};
  auto& base = place.add_coordinator("c-0");
  auto& node = place.add_node("wait");
  node.disk["identity"]["node"] =
      json(node_identity{node.name, node.uuid, 7, node.address}).dump();
  place.start(base);
  place.start(node);
  place.pass(1s);
  const std::string nonce(64, 'e');
  auto challenge = clock.ask<registration_challenge>(
      node.membership,
      registration_query{nonce, prove(status_question{nonce}, site_token)});
  clock.settle();
  registration_switch order;
  order.transfer = "t-1";
  order.node = node.name;
  order.uuid = node.uuid;
  order.epoch = 6;
  order.target = {{base.cell, base.name, base.address, base.discovery_server}};
  order.nonce = (*challenge)->value().nonce;
  order.proof = prove(order_of(order), site_token);
  auto reply = clock.ask<switch_accepted>(node.membership, order);
  place.pass(5s);
  REQUIRE(reply->has_value());
  REQUIRE_FALSE(**reply);
  CHECK(to_failure((*reply)->error()).code == error_code::conflict);
  CHECK(node.status().state == node_state::independent);
}

TEST_CASE("a node tells nobody where it stands who does not prove the site's "
          "token") {
  virtual_time clock;
  site place{clock, 1};
  auto& node = place.add_node("wait");
  place.start(node);
  place.pass(1s);
  const std::string nonce(64, 'e');
  const auto proof = prove(status_question{nonce}, site_token);
  for (const auto& query :
       {registration_query{}, registration_query{nonce, ""},
        registration_query{"", proof},
        registration_query{std::string(64, 'f'), proof},
        registration_query{nonce, prove(status_question{nonce}, "")}}) {
    auto answer = clock.ask<registration_challenge>(node.membership, query);
    clock.settle();
    REQUIRE(answer->has_value());
    REQUIRE_FALSE(**answer);
    CHECK(to_failure((*answer)->error()).code == error_code::unauthorized);
  }
}

} // namespace
