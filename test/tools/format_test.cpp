#include "tools/roscell/view/format.hpp"

#include "actors/edge/io/node_time.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <stdexcept>

using namespace roscell::cli;
using namespace std::chrono_literals;

TEST_CASE("numbers are shown without trailing zeros", "[tools]") {
  CHECK(format_number(2.0) == "2");
  CHECK(format_number(0.5) == "0.5");
  CHECK(format_number(0.126) == "0.13");
  CHECK(format_number(100) == "100");
  CHECK(format_number(-0.0001) == "0");
  CHECK(format_number(1.0 / 3, 4) == "0.3333");
}

TEST_CASE("a number that is not finite is shown as nothing known", "[tools]") {
  CHECK(format_number(std::nan("")) == "-");
  CHECK(format_number(std::numeric_limits<double>::infinity()) == "-");
}

TEST_CASE("the largest double fits its buffer", "[tools]") {
  CHECK(format_number(std::numeric_limits<double>::max(), 6).size() == 309);
}

TEST_CASE("small numbers keep their significant digits", "[tools]") {
  CHECK(format_significant(0.25, 4) == "0.25");
  CHECK(format_significant(1.0 / 3, 4) == "0.3333");
  CHECK(format_significant(1.8954636e-07, 4) == "1.895e-07");
  CHECK(format_significant(0, 6) == "0");
  CHECK(format_significant(std::nan(""), 4) == "-");
}

TEST_CASE("MiB have a decimal only where it matters", "[tools]") {
  CHECK(format_mib(812.4) == "812");
  CHECK(format_mib(9.96) == "10");
  CHECK(format_mib(1.25) == "1.2");
  CHECK(format_mib(0) == "0");
}

TEST_CASE("bytes are shown in the largest unit that is not below one",
          "[tools]") {
  CHECK(format_bytes(0) == "0 B");
  CHECK(format_bytes(1023) == "1023 B");
  CHECK(format_bytes(1024) == "1 KiB");
  CHECK(format_bytes(1536) == "1.5 KiB");
  CHECK(format_bytes(12.0 * 1024 * 1024) == "12 MiB");
  CHECK(format_bytes(5e15) == "4547 TiB");
}

TEST_CASE("an age shows its two largest units", "[tools]") {
  CHECK(format_age(999ms) == "0s");
  CHECK(format_age(59s) == "59s");
  CHECK(format_age(60s) == "1m00s");
  CHECK(format_age(3599s) == "59m59s");
  CHECK(format_age(3600s) == "1h00m");
  CHECK(format_age(26h) == "1d02h");
  CHECK(format_age(-5s) == "0s");
}

TEST_CASE("an age survives any two clocks", "[tools]") {
  const auto most = std::numeric_limits<int64_t>::max();
  const auto least = std::numeric_limits<int64_t>::min();
  CHECK(format_since(1000, 62000) == "1m01s");
  CHECK(format_since(0, 1000) == "-");
  CHECK(format_since(least, most) == "-");
  CHECK(format_since(most, 1000) == "0s");
  CHECK(format_since(1, least) == "0s");
  // Noted in 1970 by a clock that was set since then.
  CHECK(format_since(70'000, 1'795'225'380'000) == "-");
}

TEST_CASE("a time is shown in local time with milliseconds", "[tools]") {
  setenv("TZ", "UTC", 1);
  tzset();
  CHECK(roscell::local_time(0) == "1970-01-01 00:00:00.000");
  CHECK(roscell::local_time(1795269787123) == "2026-11-21 14:03:07.123");
  CHECK(roscell::local_time(-1) == "1969-12-31 23:59:59.999");
}

TEST_CASE("a terminal gets no control characters", "[tools]") {
  CHECK(printable("step \x1b[31mred\n") == "step ?[31mred?");
  CHECK(printable("\x7f\t") == "??");
  // C1 controls, a bidi override, and what is no UTF-8.
  CHECK(printable("\xc2\x9b"
                  "31m")
        == "??31m");
  CHECK(printable("\xe2\x80\xae") == "???");
  CHECK(printable("\xc0\xaf\xed\xa0\x80\xf5") == "??????");
  CHECK(printable("\xe2\x82") == "??");
}

TEST_CASE("text of any language passes as it is", "[tools]") {
  CHECK(printable("Größe 机器人 🤖") == "Größe 机器人 🤖");
}

TEST_CASE("shortened text has exactly the columns asked for", "[tools]") {
  CHECK(shortened("camera", 6) == "camera");
  CHECK(shortened("camera", 4) == "cam…");
  CHECK(shortened("größe", 4) == "grö…");
  CHECK(shortened("camera", 1) == "…");
  CHECK(shortened("camera", 0).empty());
  CHECK(display_width(shortened("größe", 4)) == 4);
}

TEST_CASE("a text takes the columns that a terminal gives it", "[tools]") {
  CHECK(display_width("größe") == 5);
  CHECK(display_width("机器人") == 6);
  CHECK(display_width("🤖 ok") == 5);
  // An accent that is a character of its own.
  CHECK(display_width("e\xcc\x81") == 1);
  CHECK(letters_in("机器人") == 3);
  CHECK(first_letter("e\xcc\x81x") == "e\xcc\x81");
}

TEST_CASE("shortened text of wide characters is never too wide", "[tools]") {
  CHECK(shortened("机器人", 6) == "机器人");
  CHECK(shortened("机器人", 5) == "机器…");
  CHECK(shortened("机器人", 4) == "机…");
  CHECK(shortened("机器人", 1) == "…");
}

TEST_CASE("sizes are read with binary units", "[tools]") {
  CHECK(parse_bytes("4096") == 4096);
  CHECK(parse_bytes("1B") == 1);
  CHECK(parse_bytes("64KiB") == 65536);
  CHECK(parse_bytes("1.5MiB") == 1572864);
  CHECK(parse_bytes("2GiB") == 2147483648);
}

TEST_CASE("a size that cannot be meant is refused", "[tools]") {
  for (const auto* text : {"", "MiB", "-1", "1MB", "1 MiB", "0.3", "1e9", "nan",
                           "99999999GiB", "1.2.3", "inf"})
    CHECK_THROWS_AS(parse_bytes(text), std::invalid_argument);
}

TEST_CASE("durations are read as seconds or with a unit", "[tools]") {
  CHECK(parse_duration("30") == 30s);
  CHECK(parse_duration("2.5") == 2500ms);
  CHECK(parse_duration("500ms") == 500ms);
  CHECK(parse_duration("2m") == 2min);
  CHECK(parse_duration("24h") == 24h);
}

TEST_CASE("a duration that cannot be meant is refused", "[tools]") {
  for (const auto* text : {"", "0", "0.1ms", "25h", "-1", "1 s", "1d", "inf"})
    CHECK_THROWS_AS(parse_duration(text), std::invalid_argument);
}
