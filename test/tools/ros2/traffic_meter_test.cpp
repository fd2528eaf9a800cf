#include "tools/roscell/ros2/traffic_meter.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using namespace std::chrono_literals;

namespace {

const traffic_meter::clock::time_point start{};

} // namespace

TEST_CASE("a rate needs two messages at different times", "[tools]") {
  traffic_meter meter{10, start};
  CHECK_FALSE(meter.metrics());
  meter.add(start, 100, 1ms);
  CHECK_FALSE(meter.metrics());
  meter.add(start, 100, 1ms);
  CHECK_FALSE(meter.metrics());
  meter.add(start + 1s, 100, 1ms);
  CHECK(meter.metrics());
}

TEST_CASE("rate, gaps and bandwidth are those between first and last",
          "[tools]") {
  traffic_meter meter{10, start};
  meter.add(start, 5000, 9ms); // Its bytes came before the time counted.
  meter.add(start + 100ms, 1000, 1ms);
  meter.add(start + 400ms, 3000, 2ms);
  const auto x = meter.metrics().value();
  CHECK(x.messages == 3);
  CHECK(x.rate_hz == Approx(5));
  CHECK(x.least_gap_ms == Approx(100));
  CHECK(x.most_gap_ms == Approx(300));
  CHECK(x.gap_deviation_ms == Approx(100));
  CHECK(x.bytes_per_s == Approx(10000));
  CHECK(x.mean_bytes == Approx(2000));
  CHECK(x.median_age_ms == Approx(2));
}

TEST_CASE("only the last messages are measured, and all are counted",
          "[tools]") {
  traffic_meter meter{3, start};
  meter.add(start, 1, 0ms);
  for (int i = 0; i < 3; ++i)
    meter.add(start + 10s + i * 100ms, 1, 0ms);
  CHECK(meter.metrics().value().rate_hz == Approx(10));
  CHECK(meter.total() == 4);
}
