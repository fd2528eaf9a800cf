#include "messages/failure.hpp"
#include "test/site/watch/site_watch.hpp"

/// What a coordinator's discovery server is told of those of its members, and
/// they of it.
namespace {

using namespace roscell;
using namespace roscell::test;

struct cell_of_two {
  virtual_time clock;
  site place{clock, 1};
  site_party& base = place.add_coordinator("c-0");
  site_party& arm = place.add_node(base.discovery_server);

  cell_of_two() {
    for (auto& x : place.parties)
      place.start(*x);
    place.pass(20s);
    REQUIRE(complaint(place).empty());
    REQUIRE(arm.status().state == node_state::member);
  }

  /// What was told since the last time, oldest first.
  std::vector<server_contact> reported() {
    std::vector<server_contact> result;
    for (const auto& x : base.followed)
      result.push_back(x.contact);
    base.followed.clear();
    return result;
  }
};

using contacts = std::vector<server_contact>;

TEST_CASE("a member's discovery server is met at its registration",
          "[servers]") {
  cell_of_two x;
  REQUIRE(x.base.followed.size() == 1);
  const auto met = x.base.followed.front();
  CHECK(met.contact == server_contact::met);
  CHECK(met.server_id
        == x.base.cell_state().registry.find_uuid(x.arm.uuid)->server_id);
  CHECK(met.tells_anew);
  REQUIRE(x.arm.served);
  CHECK(x.arm.served->remote_is_there);
  CHECK(x.arm.served->tells_anew);
}

TEST_CASE("both discovery servers lose each other with the session and meet "
          "with the next",
          "[servers]") {
  cell_of_two x;
  x.reported();
  x.place.split({0, 1});
  x.place.pass(20s);
  CHECK(x.reported() == contacts{server_contact::lost});
  CHECK_FALSE(x.arm.served->remote_is_there);
  x.place.heal_all();
  x.place.pass(40s);
  CHECK(x.reported() == contacts{server_contact::met});
  CHECK(x.arm.served->remote_is_there);
}

TEST_CASE("programs of a host that is silent for a minute are taken for ended",
          "[servers]") {
  cell_of_two x;
  x.reported();
  x.place.split({0, 1});
  x.place.pass(50s);
  CHECK(x.reported() == contacts{server_contact::lost});
  x.place.pass(30s);
  REQUIRE(x.base.followed.size() == 1);
  CHECK(x.base.followed.front().contact == server_contact::settled);
  CHECK(x.base.followed.front().meeting == 0);
}

TEST_CASE("programs of a node that was killed go on to be known", "[servers]") {
  cell_of_two x;
  x.reported();
  x.place.kill(x.arm);
  x.place.pass(200s);
  CHECK(x.reported() == contacts{server_contact::lost});
}

TEST_CASE("what a released node's discovery server has told of ends",
          "[servers]") {
  cell_of_two x;
  x.reported();
  node_release request;
  request.node = x.arm.name;
  const auto reply = x.clock.ask<node_released>(x.base.coordinator, request);
  x.place.pass(20s);
  REQUIRE(*reply);
  REQUIRE(**reply);
  const auto reported = x.reported();
  REQUIRE_FALSE(reported.empty());
  CHECK(reported.back() == server_contact::gone);
}

TEST_CASE("a coordinator that starts anew meets its members anew",
          "[servers]") {
  cell_of_two x;
  x.reported();
  x.place.kill(x.base);
  x.place.pass(2s);
  x.place.start(x.base);
  x.place.pass(60s);
  CHECK(x.reported() == contacts{server_contact::met});
  CHECK(x.arm.served->remote_is_there);
}

} // namespace
