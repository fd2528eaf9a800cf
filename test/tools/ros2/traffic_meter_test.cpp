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

namespace {

/// Ten messages a second for a second, the last at its end.
traffic_meter ten_hertz() {
  traffic_meter result{100, start};
  for (int i = 0; i <= 10; ++i)
    result.add(start + i * 100ms, 1000, 1ms);
  return result;
}

} // namespace

TEST_CASE("a topic that has fallen silent is not shown with its last rate",
          "[tools]") {
  const auto meter = ten_hertz();
  const auto ended = start + 1s;
  CHECK(traffic_line(meter, ended + 999ms).substr(0, 6) == "10 Hz,");
  CHECK(traffic_line(meter, ended + 1s) == "no new message for 1 s\n");
  CHECK(traffic_line(meter, ended + 12900ms) == "no new message for 12 s\n");
}

TEST_CASE("programs read how long nothing came, and no rate of the past",
          "[tools]") {
  const auto meter = ten_hertz();
  const auto ended = start + 1s;
  const auto during = traffic_json(meter, ended + 500ms);
  CHECK(during.at("rate_hz") == Approx(10));
  CHECK(during.at("silent_s") == Approx(0.5));
  const auto after = traffic_json(meter, ended + 12500ms);
  CHECK(after.at("messages") == 0);
  CHECK(after.at("silent_s") == Approx(12.5));
  CHECK_FALSE(after.contains("rate_hz"));
}

TEST_CASE("a topic on which nothing came yet is silent from the start",
          "[tools]") {
  traffic_meter meter{100, start};
  CHECK(traffic_line(meter, start + 3s) == "no message for 3 s\n");
  CHECK(traffic_json(meter, start + 3s).at("silent_s") == Approx(3));
  meter.add(start + 3s, 10, 1ms);
  CHECK(traffic_line(meter, start + 3s) == "too few messages to measure\n");
}

TEST_CASE("a topic that comes again is measured again", "[tools]") {
  auto meter = ten_hertz();
  meter.add(start + 9s, 1000, 1ms);
  CHECK(traffic_json(meter, start + 9s).at("most_gap_ms") == Approx(8000));
}
