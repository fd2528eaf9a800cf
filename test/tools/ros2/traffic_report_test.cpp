#include "tools/roscell/ros2/traffic_meter.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using namespace std::chrono_literals;

namespace {

const traffic_meter::clock::time_point listening_since{};

/// Ten messages a second for a second, the last at its end.
traffic_meter ten_hertz() {
  traffic_meter result{100, listening_since};
  for (int i = 0; i <= 10; ++i)
    result.add(listening_since + i * 100ms, 1000, 1ms);
  return result;
}

} // namespace

TEST_CASE("a topic that has fallen silent is not shown with its last rate",
          "[tools]") {
  const auto meter = ten_hertz();
  const auto ended = listening_since + 1s;
  CHECK(traffic_line(meter, ended + 999ms).substr(0, 6) == "10 Hz,");
  CHECK(traffic_line(meter, ended + 1s) == "no new message for 1 s\n");
  CHECK(traffic_line(meter, ended + 12900ms) == "no new message for 12 s\n");
}

TEST_CASE("programs read how long nothing came, and no rate of the past",
          "[tools]") {
  const auto meter = ten_hertz();
  const auto ended = listening_since + 1s;
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
  traffic_meter meter{100, listening_since};
  CHECK(traffic_line(meter, listening_since + 3s) == "no message for 3 s\n");
  CHECK(traffic_json(meter, listening_since + 3s).at("silent_s") == Approx(3));
  meter.add(listening_since + 3s, 10, 1ms);
  CHECK(traffic_line(meter, listening_since + 3s)
        == "too few messages to measure\n");
}

TEST_CASE("a topic that comes again is measured again", "[tools]") {
  auto meter = ten_hertz();
  meter.add(listening_since + 9s, 1000, 1ms);
  CHECK(traffic_json(meter, listening_since + 9s).at("most_gap_ms")
        == Approx(8000));
}
