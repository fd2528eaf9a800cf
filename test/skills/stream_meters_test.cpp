#include "skills/engine/life/stream_meters.hpp"

#include <catch2/catch.hpp>

using namespace roscell::engine;
using namespace std::chrono_literals;

namespace {

const stream_meter::clock::time_point start{1000s};

} // namespace

TEST_CASE("a stream without a frame has no age and no rate") {
  stream_meter meter{start};
  CHECK_FALSE(meter.take(start + 9s).age);
  CHECK(meter.take(start + 9s).rate_hz == 0);
}

TEST_CASE("a rate is that of the frames since the value before") {
  stream_meter meter{start};
  for (int i = 1; i <= 10; ++i)
    meter.count(start + i * 100ms);
  CHECK(meter.take(start + 1s).rate_hz == Approx(10));
  for (int i = 1; i <= 20; ++i)
    meter.count(start + 1s + i * 50ms);
  CHECK(meter.take(start + 2s).rate_hz == Approx(20));
}

TEST_CASE("a rate does not depend on when it is asked for") {
  stream_meter meter{start};
  meter.count(start + 800ms);
  meter.take(start + 1s);
  // Frames every 800 ms, asked every second: one or two of them at a time.
  for (int i = 2; i < 40; ++i) {
    const auto now = start + i * 1s;
    for (auto at = start + 800ms; at <= now; at += 800ms)
      if (at > now - 1s)
        meter.count(at);
    CHECK(meter.take(now).rate_hz == Approx(1.25));
  }
}

TEST_CASE("a rate falls as long as nothing comes, and not at once to 0") {
  stream_meter meter{start};
  meter.count(start + 1s);
  meter.take(start + 1s);
  CHECK(meter.take(start + 2s).rate_hz == Approx(1));
  CHECK(meter.take(start + 6s).rate_hz == Approx(0.2));
  CHECK(meter.take(start + 6s).age == 5s);
}

TEST_CASE("frames of one moment have a rate that is a number") {
  stream_meter meter{start};
  meter.count(start);
  meter.count(start);
  CHECK(meter.take(start).rate_hz == Approx(2000));
  CHECK(meter.take(start).rate_hz == Approx(1000));
}

TEST_CASE("streams are told in the words of the node") {
  stream_meters meters{2, 1, start};
  meters.input(0).count(start + 1s);
  meters.output(0).count(start + 500ms);
  CHECK(meters.take_text(start + 1033ms)
        == "input:0 1.000 0.033;input:1 0.000 -;output:0 2.000 0.533");
}

TEST_CASE("no more streams are told than a node reads") {
  stream_meters meters{64, 64, start};
  const auto text = meters.take_text(start);
  CHECK(text.find("input:15 ") != std::string::npos);
  CHECK(text.find("output:15 ") != std::string::npos);
  CHECK(text.find(":16 ") == std::string::npos);
}

TEST_CASE("all frames of a stream are counted, whoever takes metrics") {
  stream_meter meter{start};
  meter.count(start);
  meter.take(start + 1s);
  meter.count(start + 2s);
  CHECK(meter.total() == 2);
}
