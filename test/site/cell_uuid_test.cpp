#include "test/site/watch/site_watch.hpp"

/// A cell's name may be claimed twice; its UUID is its own.
namespace {

using namespace roscell;
using namespace roscell::test;

struct two_of_one_name {
  virtual_time clock;
  site place{clock, 1};
  site_party& own = place.add_coordinator("c-0");
  site_party& other = place.add_coordinator("c-1");
  site_party& node = place.add_node(own.discovery_server);

  two_of_one_name() {
    other.cell = own.cell;
    place.start(own);
    place.start(node);
    place.pass(10s);
    REQUIRE(node.status().state == node_state::member);
  }
};

TEST_CASE("an orphan comes back to its cell, not to another of that name",
          "[cell_uuid]") {
  two_of_one_name x;
  x.place.kill(x.own);
  x.place.start(x.other);
  x.place.pass(60s);
  CHECK(x.node.status().state == node_state::orphaned);
  CHECK_FALSE(x.other.cell_state().registry.find_uuid(x.node.uuid));
  CHECK(x.place.count("join_refused") == 0);
  x.place.start(x.own);
  x.place.pass(60s);
  CHECK(x.node.status().state == node_state::member);
  CHECK(x.own.cell_state().registry.find_uuid(x.node.uuid));
}

TEST_CASE("a cell refuses an orphan of another cell at its address",
          "[cell_uuid]") {
  two_of_one_name x;
  x.place.kill(x.own);
  // The other coordinator has moved to the address.
  x.other.discovery_server = x.own.discovery_server;
  x.place.start(x.other);
  x.place.pass(60s);
  CHECK(x.node.status().state == node_state::orphaned);
  REQUIRE(x.node.status().report.rows().size() == 1);
  CHECK(x.node.status().report.rows()[0].problem.find("another cell")
        != std::string::npos);
  CHECK_FALSE(x.other.cell_state().registry.find_uuid(x.node.uuid));
}

TEST_CASE("an orphan returns to its cell under the cell's new name",
          "[cell_uuid]") {
  two_of_one_name x;
  x.place.kill(x.own);
  x.own.cell = "renamed";
  x.place.start(x.own);
  x.place.pass(60s);
  CHECK(x.node.status().state == node_state::member);
  CHECK(x.node.status().cell == "renamed");
  CHECK(x.own.cell_state().registry.find_uuid(x.node.uuid));
}

TEST_CASE("a member remembers its cell's UUID over a restart", "[cell_uuid]") {
  two_of_one_name x;
  x.place.kill(x.node);
  x.place.kill(x.own);
  x.place.start(x.other);
  x.place.start(x.node);
  x.place.pass(60s);
  CHECK(x.node.status().state == node_state::orphaned);
  CHECK_FALSE(x.other.cell_state().registry.find_uuid(x.node.uuid));
}

TEST_CASE("a member that never heard of a cell's UUID goes by its name",
          "[cell_uuid]") {
  two_of_one_name x;
  auto& record = x.node.disk["identity"]["membership"];
  auto document = json::parse(record);
  document.erase("cell_uuid");
  x.place.kill(x.node);
  record = document.dump();
  x.place.start(x.node);
  x.place.pass(20s);
  CHECK(x.node.status().state == node_state::member);
  CHECK(json::parse(record).at("cell_uuid") == "ce-c-0");
}

} // namespace
