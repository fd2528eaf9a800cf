#include "actors/edge/engine/engine_log.hpp"
#include "actors/edge/limits.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace roscell;

namespace {

std::string frame(const std::string& payload, char stream = 1) {
  std::string result{stream, 0, 0, 0};
  for (const int shift : {24, 16, 8, 0})
    result += static_cast<char>(payload.size() >> shift & 255);
  return result + payload;
}

/// A line at so many microseconds after the origin of the tests.
std::string line(int microseconds, const std::string& text) {
  char time[64];
  std::snprintf(time, sizeof time, "2026-11-21T20:54:31.%06d000Z ",
                microseconds);
  return frame(time + text + "\n");
}

const log_ticks origin = *parse_log_time("2026-11-21T20:54:31Z");

} // namespace

TEST_CASE("log times are read to 100 ns, in any zone") {
  CHECK(parse_log_time("1970-01-01T00:00:00Z") == 0);
  CHECK(parse_log_time("1970-01-01T00:00:00.000000199Z") == 1);
  CHECK(parse_log_time("2026-11-21T20:54:31.5Z") == 17952944715000000);
  CHECK(parse_log_time("2026-11-21T21:54:31.500000000+01:00")
        == 17952944715000000);
  CHECK(parse_log_time("2024-02-29T00:00:00Z").value()
            + int64_t{86400} * 1000 * log_ticks_per_ms
        == parse_log_time("2024-03-01T00:00:00Z"));
  for (const auto* text : {"", "2026-11-21", "2026-11-21T20:54:31",
                           "2026-11-21T20:54:31.Z", "2026-13-21T20:54:31Z",
                           "2026-11-21T20:54:31Zx", "+026-11-21T20:54:31Z"})
    CHECK_FALSE(parse_log_time(text));
}

TEST_CASE("a log comes out of its frames, however they are cut") {
  const auto bytes = line(1, "one") + line(2, "two") + line(3, "three");
  for (size_t piece = 1; piece <= bytes.size(); ++piece) {
    log_collector collector{{origin, 0, false}};
    for (size_t at = 0; at < bytes.size(); at += piece)
      CHECK(collector.take(std::string_view{bytes}.substr(at, piece)));
    CHECK(collector.part().text == "one\ntwo\nthree\n");
    CHECK(collector.part().next_offset == 31);
  }
}

TEST_CASE("a query goes on where the last one ended") {
  const auto bytes = line(1, "one") + line(2, "two");
  log_collector first{{origin, 0, false}};
  first.take(bytes);
  const auto next = first.part().next_offset;
  log_collector second{{origin, next, false}};
  second.take(bytes);
  CHECK(second.empty());
  CHECK(second.part().next_offset == next);
  second.take(line(3, "three"));
  CHECK(second.part().text == "three\n");
}

TEST_CASE("a part of a log is bounded") {
  const std::string text(1000, 'x');
  std::string bytes;
  for (int i = 0; i < 200; ++i)
    bytes += line(i, std::to_string(i) + text);
  SECTION("from an offset it is the first part") {
    log_collector collector{{origin, 0, false}};
    CHECK_FALSE(collector.take(bytes));
    const auto part = collector.part();
    CHECK(part.text.size() <= limits::log::part_bytes);
    CHECK(part.text.substr(0, 2) == "0x");
    log_collector rest{{origin, part.next_offset, false}};
    rest.take(bytes);
    CHECK(rest.part().text.substr(0, 3) == "65x");
  }
  SECTION("of the last lines it is the last part") {
    log_collector collector{{origin, 0, true}};
    CHECK(collector.take(bytes));
    const auto part = collector.part();
    CHECK(part.text.size() <= limits::log::part_bytes);
    CHECK(part.text.find("199x") != std::string::npos);
  }
}

TEST_CASE(
    "a part of a log with times has so many lines that an answer can hold "
    "them") {
  std::string bytes;
  for (int i = 0; i < 10'000; ++i)
    bytes += line(i, "a");
  SECTION("from an offset it is the first part") {
    log_collector collector{{origin, 0, false, true}};
    CHECK_FALSE(collector.take(bytes));
    CHECK(collector.part().times_unix_ms.size() == size_t{most_timed_lines});
  }
  SECTION("of the last lines it is the last part") {
    log_collector collector{{origin, 0, true, true}};
    CHECK(collector.take(bytes));
    CHECK(collector.part().times_unix_ms.size() == size_t{most_timed_lines});
  }
}

TEST_CASE("what is no log is noticed") {
  log_collector html{{origin, 0, false}};
  CHECK_FALSE(html.take("<html>no log</html>"));
  log_collector huge{{origin, 0, false}};
  CHECK_FALSE(huge.take(std::string{"\1\0\0\0\xff\xff\xff\xff", 8}));
  log_collector timeless{{origin, 0, false}};
  CHECK(timeless.take(frame("no time at all\n")));
  CHECK(timeless.empty());
}

TEST_CASE("a part of a log tells when its lines were logged, if asked") {
  const auto bytes = line(1, "one") + line(20'000, "two");
  log_collector silent{{origin, 0, false}};
  silent.take(bytes);
  CHECK(silent.part().times_unix_ms.empty());
  log_collector annotating{{origin, 0, false, true}};
  annotating.take(bytes);
  const auto first = annotating.part().times_unix_ms;
  REQUIRE(first.size() == 2);
  CHECK(first[1] == first[0] + 20);
}

TEST_CASE("the end of a log that is too long keeps the times of its lines") {
  const std::string text(999, 'x');
  log_collector collector{{origin, 0, true, true}};
  for (int i = 0; i < 200; ++i)
    collector.take(line(i * 1000, text));
  const auto part = collector.part();
  const auto lines = std::count(part.text.begin(), part.text.end(), '\n');
  REQUIRE(part.times_unix_ms.size() == static_cast<size_t>(lines));
  CHECK(part.times_unix_ms.back() - part.times_unix_ms.front() == lines - 1);
}

TEST_CASE("bytes that are no text are replaced") {
  log_collector collector{{origin, 0, false}};
  collector.take(line(1, "a\xff"));
  CHECK(collector.part().text == "a\xEF\xBF\xBD\n");
}
