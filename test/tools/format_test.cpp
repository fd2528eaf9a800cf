#include "tools/roscell/view/format.hpp"

#include "actors/edge/io/node_time.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <ctime>
#include <stdexcept>

using namespace roscell::cli;
using namespace std::chrono_literals;

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
