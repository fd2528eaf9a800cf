#include "actors/core/shifted_times.hpp"

#include "actors/edge/io/node_time.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

constexpr int64_t in_1970 = 60'000;
constexpr int64_t today = 1'795'225'380'000;

/// What a node that began in 1970 tells once its clock was set.
constexpr time_shift since_1970{in_1970, in_1970 + 3'600'000, today - in_1970};

} // namespace

TEST_CASE("what was noted before the clock was set is told by the clock of now",
          "[times]") {
  json x{{"since_unix_ms", in_1970 + 5000},
         {"ends", {{{"unix_ms", in_1970}}}},
         {"cell", "line"}};
  shift_times(x, since_1970);
  CHECK(x["since_unix_ms"] == today + 5000);
  CHECK(x["ends"][0]["unix_ms"] == today);
  CHECK(x["cell"] == "line");
}

TEST_CASE("what another run has noted, or nobody, stays as it was told",
          "[times]") {
  json x{{"since_unix_ms", today - 86'400'000},
         {"ended_unix_ms", 0},
         {"added_unix_ms", in_1970},
         {"times_unix_ms", {in_1970}},
         {"clock_unix_us", in_1970}};
  const auto before = x;
  shift_times(x, since_1970);
  CHECK(x == before);
}

TEST_CASE("a text is changed only where a time in it is", "[times]") {
  const std::string text = R"({"b": 1,  "a_unix_ms": 60000})";
  CHECK(with_times_shifted(text, {0, today, 0}) == text);
  CHECK(with_times_shifted("unix_ms, no JSON", since_1970)
        == "unix_ms, no JSON");
  CHECK(json::parse(with_times_shifted(text, since_1970))["a_unix_ms"]
        == today);
}

TEST_CASE("a clock that nobody has set shifts nothing", "[times]") {
  CHECK(to_wall_clock().by == 0);
  const auto now = node_time_ms();
  CHECK(to_wall_clock()(now) == now);
}

TEST_CASE("times of a peer become those of this node", "[times]") {
  // Its clock is a day behind, and is not the one that noted the second time.
  const auto ahead = int64_t{86'400'000};
  const auto shift = from_peer(ahead);
  const auto now = node_time_ms();
  CHECK(shift(now - ahead - 1000) == now - 1000);
  CHECK(shift(now - 1000) == now - 1000);
  CHECK(shift(0) == 0);
  // What was before 1970 by a clock of that year is as old as can be told.
  CHECK(from_peer(-today)(1000) == 1);
}
