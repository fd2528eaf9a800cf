#include "actors/requests/cost/cost_ring.hpp"
#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell::test {

using namespace std::chrono_literals;

namespace {

/// A node that uses 1 s of a core, writes 100 bytes and sends "arm" 10 bytes
/// each minute, and gets half of that from it.
struct ring_fixture {
  cost_ring ring;
  cost_ring::time_point now = time_zero;
  cost_reading reading{5, 1000, 7000, {{"arm", 400, 300}}};

  ring_fixture() {
    ring.mark(now, reading);
  }

  void mark_after(std::chrono::seconds span) {
    now += span;
    ring.mark(now, reading);
  }

  void work(std::chrono::minutes span) {
    for (; span > 0min; span -= 1min) {
      reading.cpu_s += 1;
      reading.written_bytes += 100;
      reading.peers[0].sent_bytes += 10;
      reading.peers[0].received_bytes += 5;
      mark_after(60s);
    }
  }

  cost_window window(size_t i) const {
    const auto all = ring.windows();
    REQUIRE(all.size() == 3);
    return all[i];
  }

  cost_window minute() const {
    return window(0);
  }

  cost_window hour() const {
    return window(1);
  }

  cost_window day() const {
    return window(2);
  }
};

} // namespace

TEST_CASE("Before the second reading nothing is known", "[cost]") {
  cost_ring ring;
  CHECK(ring.windows()[0] == cost_window{"minute", 0, 0, 0, 0, {}});
  ring.mark(time_zero, {5, 1000, 7000, {{"arm", 400, 300}}});
  CHECK(ring.windows()[2] == cost_window{"day", 0, 0, 1000, 0, {}});
}

TEST_CASE_METHOD(ring_fixture, "What was used before it began does not count",
                 "[cost]") {
  reading.cpu_s += 0.5;
  reading.written_bytes += 30;
  reading.peers[0].sent_bytes += 6;
  mark_after(20s);
  for (const auto& x : ring.windows()) {
    CHECK(x.span_s == 20);
    CHECK(x.cpu_s == 0.5);
    CHECK(x.written_bytes == 30);
    CHECK(x.peers == std::vector<peer_traffic>{{"arm", 6, 0}});
  }
}

TEST_CASE_METHOD(ring_fixture,
                 "The last minute is a complete one and what came after it",
                 "[cost]") {
  work(5min);
  CHECK(minute() == cost_window{"minute", 60, 1, 1000, 100, {{"arm", 10, 5}}});
  reading.cpu_s += 7;
  mark_after(30s);
  CHECK(minute().span_s == 90);
  CHECK(minute().cpu_s == 8);
  mark_after(30s);
  CHECK(minute().span_s == 60);
  CHECK(minute().cpu_s == 7);
}

TEST_CASE_METHOD(ring_fixture,
                 "The last hour is told from slices of ten minutes", "[cost]") {
  work(60min);
  CHECK(hour()
        == cost_window{"hour", 3600, 60, 1000, 6000, {{"arm", 600, 300}}});
  work(9min);
  CHECK(hour().span_s == 69 * 60);
  CHECK(hour().cpu_s == 69);
  work(1min);
  CHECK(hour().span_s == 3600);
  CHECK(hour().cpu_s == 60);
}

TEST_CASE_METHOD(ring_fixture, "The last day is told from slices of four hours",
                 "[cost]") {
  work(24h);
  CHECK(day().span_s == 24 * 3600);
  CHECK(day().cpu_s == 24 * 60);
  work(3h + 59min);
  CHECK(day().span_s == (27 * 60 + 59) * 60);
  work(1min);
  CHECK(day().span_s == 24 * 3600);
  CHECK(day().written_bytes == 24 * 60 * 100);
}

TEST_CASE_METHOD(ring_fixture, "Memory is the mean over the time", "[cost]") {
  reading.pss_bytes = 4000;
  mark_after(10s);
  reading.pss_bytes = 1000;
  mark_after(30s);
  CHECK(minute().pss_bytes == 1750);
}

TEST_CASE_METHOD(ring_fixture, "A counter that went backwards has begun anew",
                 "[cost]") {
  reading = {2, 1000, 10, {{"arm", 3, 400}}};
  mark_after(60s);
  CHECK(minute() == cost_window{"minute", 60, 2, 1000, 10, {{"arm", 3, 100}}});
}

TEST_CASE_METHOD(ring_fixture, "A time that went backwards is none", "[cost]") {
  mark_after(30s);
  mark_after(-10s);
  CHECK(minute().span_s == 30);
  mark_after(20s);
  CHECK(minute().span_s == 40);
}

TEST_CASE_METHOD(ring_fixture, "A peer without traffic in a window is not told",
                 "[cost]") {
  reading.peers.push_back({"leg", 8, 8});
  mark_after(60s);
  CHECK(minute().peers == std::vector<peer_traffic>{{"leg", 8, 8}});
  mark_after(60s);
  CHECK(minute().peers.empty());
  CHECK(hour().peers.size() == 1);
}

TEST_CASE("Peers beyond the most count together", "[cost]") {
  cost_ring ring;
  cost_reading reading;
  for (size_t i = 0; i < cost_ring::max_peers + 10; ++i)
    reading.peers.push_back({"peer-" + std::to_string(i)});
  reading.peers.push_back({"other"});
  ring.mark(time_zero, reading);
  for (auto& x : reading.peers)
    x.sent_bytes += 2;
  ring.mark(time_zero + 60s, reading);
  const auto peers = ring.windows()[0].peers;
  REQUIRE(peers.size() == cost_ring::max_peers + 1);
  CHECK(peers.front() == peer_traffic{"other", 22, 0});
  CHECK(peers.back() == peer_traffic{"peer-63", 2, 0});
}

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
