#include "skills/ros2/flow/pace.hpp"

#include <catch2/catch.hpp>

using namespace roscell::ros2;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t image_bytes = 1'228'800;
const writer_pace::clock::time_point start =
    writer_pace::clock::time_point{} + 1h;

/// The gap after some messages of this period.
writer_pace::clock::duration settled_gap(writer_pace& pace,
                                         writer_pace::clock::duration period,
                                         std::size_t bytes) {
  writer_pace::clock::duration result{};
  for (int i = 0; i < 20; ++i)
    result = pace.next_gap(start + i * period, bytes);
  return result;
}

} // namespace

TEST_CASE("datagrams are held back only while a best-effort stock reader is "
          "there") {
  writer_pace pace;
  CHECK(settled_gap(pace, 100ms, image_bytes) == 0ms);
  pace.set_best_effort_readers(1);
  CHECK(settled_gap(pace, 100ms, image_bytes) == 2ms);
  pace.set_best_effort_readers(0);
  CHECK(settled_gap(pace, 100ms, image_bytes) == 0ms);
}

TEST_CASE("a message takes up half the time until the next at most") {
  writer_pace pace;
  pace.set_best_effort_readers(1);
  // 4 MiB are 65 datagrams.
  const auto gap = settled_gap(pace, 33ms, 4 << 20);
  CHECK(gap * 65 <= 17ms);
  CHECK(gap * 65 >= 15ms);
}

TEST_CASE("small messages are not held back, and a pause does not count") {
  writer_pace pace;
  pace.set_best_effort_readers(1);
  CHECK(settled_gap(pace, 100ms, 129'000) == 0ms);
  const auto before = settled_gap(pace, 33ms, 4 << 20);
  CHECK(pace.next_gap(start + 10min, 4 << 20) == before);
}
