#include "client/value_text.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace roscell;
using namespace std::chrono_literals;

TEST_CASE("numbers are shown without trailing zeros", "[client]") {
  CHECK(format_number(2.0) == "2");
  CHECK(format_number(0.5) == "0.5");
  CHECK(format_number(0.126) == "0.13");
  CHECK(format_number(100) == "100");
  CHECK(format_number(-0.0001) == "0");
  CHECK(format_number(1.0 / 3, 4) == "0.3333");
}

TEST_CASE("a number that is not finite is shown as nothing known", "[client]") {
  CHECK(format_number(std::nan("")) == "-");
  CHECK(format_number(std::numeric_limits<double>::infinity()) == "-");
}

TEST_CASE("the largest double fits its buffer", "[client]") {
  CHECK(format_number(std::numeric_limits<double>::max(), 6).size() == 309);
}

TEST_CASE("small numbers keep their significant digits", "[client]") {
  CHECK(format_significant(0.25, 4) == "0.25");
  CHECK(format_significant(1.0 / 3, 4) == "0.3333");
  CHECK(format_significant(1.8954636e-07, 4) == "1.895e-07");
  CHECK(format_significant(0, 6) == "0");
  CHECK(format_significant(std::nan(""), 4) == "-");
}

TEST_CASE("MiB have a decimal only where it matters", "[client]") {
  CHECK(format_mib(812.4) == "812");
  CHECK(format_mib(9.96) == "10");
  CHECK(format_mib(1.25) == "1.2");
  CHECK(format_mib(0) == "0");
}

TEST_CASE("bytes are shown in the largest unit that is not below one",
          "[client]") {
  CHECK(format_bytes(0) == "0 B");
  CHECK(format_bytes(1023) == "1023 B");
  CHECK(format_bytes(1024) == "1 KiB");
  CHECK(format_bytes(1536) == "1.5 KiB");
  CHECK(format_bytes(12.0 * 1024 * 1024) == "12 MiB");
  CHECK(format_bytes(5e15) == "4547 TiB");
}

TEST_CASE("an age shows its two largest units", "[client]") {
  CHECK(format_age(999ms) == "0s");
  CHECK(format_age(59s) == "59s");
  CHECK(format_age(60s) == "1m00s");
  CHECK(format_age(3599s) == "59m59s");
  CHECK(format_age(3600s) == "1h00m");
  CHECK(format_age(26h) == "1d02h");
  CHECK(format_age(-5s) == "0s");
}

TEST_CASE("an age survives any two clocks", "[client]") {
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
