#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <ctime>
#include <stdexcept>

namespace roscell::cli {

namespace {

/// 2026-11-26 21:30:00 UTC.
constexpr int64_t now_ms = 1'795'728'600'000;
constexpr int64_t hour_ms = 3'600'000;

int64_t time_of(const char* text) {
  return parse_event_start(text, now_ms).unix_ms;
}

} // namespace

TEST_CASE("events begin at a number, or with all that is kept", "[tools]") {
  CHECK(parse_event_start("17", now_ms).number == 17);
  CHECK(time_of("17") == 0);
  CHECK(parse_event_start("17", now_ms).on_disk);
  CHECK_FALSE(parse_event_start("0", now_ms).on_disk);
  CHECK(parse_event_start("start", now_ms).on_disk);
  CHECK(parse_event_start("start", now_ms).number == 0);
  CHECK(time_of("start") == 0);
}

TEST_CASE("events begin a span ago", "[tools]") {
  CHECK(time_of("2h") == now_ms - 2 * hour_ms);
  CHECK(time_of("7d") == now_ms - 7 * 24 * hour_ms);
  CHECK(time_of("90s") == now_ms - 90'000);
  // Nothing was before 1970.
  CHECK(time_of("36500d") == 1);
}

TEST_CASE("events begin at a moment", "[tools]") {
  ::setenv("TZ", "CET-1CEST", 1);
  ::tzset();
  CHECK(time_of("2026-11-26T21:30:00Z") == now_ms);
  CHECK(time_of("2026-11-26 22:30") == now_ms);
  CHECK(time_of("2026-11-26 22:30:00") == now_ms);
  CHECK(time_of("2026-11-26") == now_ms - 22 * hour_ms - hour_ms / 2);
  CHECK(time_of("22:00") == now_ms - hour_ms / 2);
  // The last one that was.
  CHECK(time_of("23:30") == now_ms - 23 * hour_ms);
  ::unsetenv("TZ");
  ::tzset();
}

TEST_CASE("what is no moment is refused in words", "[tools]") {
  const auto* text =
      GENERATE("", "yesterday", "2x", "-1", "2026-13-01", "25:00", "2h30m",
               "99999999999999999999", "99999999999d", "2026-11-26 1");
  CHECK_THROWS_AS(parse_event_start(text, now_ms), std::invalid_argument);
}

TEST_CASE("a span has one unit", "[tools]") {
  CHECK(parse_span("0s").count() == 0);
  CHECK(parse_span("5m").count() == 300);
  for (const auto* text : {"", "5", "m", "1.5h", "5 m", "5w"})
    CHECK_THROWS_AS(parse_span(text), std::invalid_argument);
}

} // namespace roscell::cli
