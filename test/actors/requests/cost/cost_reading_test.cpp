#include "actors/requests/cost/cost_reading.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

TEST_CASE("What went over sessions is read for each peer", "[cost]") {
  const auto book = std::make_shared<metric_book>();
  book->add(metric::session_sent_bytes, {"leg"}, 5);
  book->add(metric::session_sent_bytes, {"arm"}, 7);
  book->add(metric::session_received_bytes, {"arm"}, 9);
  CHECK(read_cost(book).peers
        == std::vector<peer_traffic>{{"arm", 7, 9}, {"leg", 5, 0}});
}

TEST_CASE("What this process costs is read without a book, too", "[cost]") {
  const auto reading = read_cost(nullptr);
  CHECK(reading.pss_bytes > 1024 * 1024);
  CHECK(reading.peers.empty());
}

} // namespace roscell::test
