#include "actors/requests/cost/cost_reading.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("What went over sessions is read for each peer", "[cost]") {
  const auto table = std::make_shared<metric_table>();
  table->add(metric::session_sent_bytes, {"leg"}, 5);
  table->add(metric::session_sent_bytes, {"arm"}, 7);
  table->add(metric::session_received_bytes, {"arm"}, 9);
  CHECK(read_cost(table).peers
        == std::vector<peer_traffic>{{"arm", 7, 9}, {"leg", 5, 0}});
}

TEST_CASE("What this process costs is read without a table, too", "[cost]") {
  const auto reading = read_cost(nullptr);
  CHECK(reading.pss_bytes > 1024 * 1024);
  CHECK(reading.peers.empty());
}

} // namespace roscell::test
