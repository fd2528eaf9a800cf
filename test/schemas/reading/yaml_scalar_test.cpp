#include "schemas/reading/yaml_scalar.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace roscell;

namespace {

json meant(const std::string& text) {
  const auto result = plain_scalar(text);
  INFO(text);
  REQUIRE(result);
  return *result;
}

} // namespace

TEST_CASE("null and booleans are the words of the core schema") {
  for (const auto* text : {"", "~", "null", "Null", "NULL"})
    CHECK(meant(text).is_null());
  for (const auto* text : {"true", "True", "TRUE"})
    CHECK(meant(text) == true);
  for (const auto* text : {"false", "False", "FALSE"})
    CHECK(meant(text) == false);
}

TEST_CASE("words that older YAML took for booleans are text") {
  for (const auto* text : {"yes", "no", "on", "off", "y", "nULL", "tRUE"})
    CHECK(meant(text) == text);
}

TEST_CASE("integers are decimal, octal or hexadecimal") {
  CHECK(meant("0").is_number_unsigned());
  CHECK(meant("7") == 7);
  CHECK(meant("+7") == 7);
  CHECK(meant("-7") == -7);
  CHECK(meant("007") == 7);
  CHECK(meant("0o17") == 15);
  CHECK(meant("0xfF") == 255);
  CHECK(meant("18446744073709551615") == std::numeric_limits<uint64_t>::max());
  CHECK(meant("-9223372036854775808") == std::numeric_limits<int64_t>::min());
}

TEST_CASE("an integer beyond 64 bits is a floating-point number, as in JSON") {
  CHECK(meant("18446744073709551616") == json::parse("18446744073709551616"));
  CHECK(meant("-9223372036854775809").is_number_float());
}

TEST_CASE("floating-point numbers are read as JSON reads them") {
  for (const auto* text : {"0.1", "-2.5e3", "1E-7", "1e308"})
    CHECK(meant(text) == json::parse(text));
  CHECK(meant(".5") == 0.5);
  CHECK(meant("5.") == 5.0);
  CHECK(meant("+.5e1") == 5.0);
}

TEST_CASE("a number that no double holds is none") {
  for (const auto* text : {".inf", "-.Inf", "+.INF", ".nan", ".NaN", "1e999",
                           "0xfffffffffffffffff"})
    CHECK_FALSE(plain_scalar(text));
  CHECK_FALSE(plain_scalar(std::string(5000, '9')));
}

TEST_CASE("what only looks like a number is text") {
  for (const auto* text : {"1.0.0",
                           "1_000",
                           "12:30",
                           "2026-11-22",
                           "-",
                           "+",
                           ".",
                           "..",
                           "e5",
                           "--5",
                           "+-5",
                           "0x",
                           "0xg",
                           "0o8",
                           "-0x1",
                           "1e",
                           "inf",
                           "nan",
                           "infinity",
                           ".infx",
                           "0.5cores",
                           "1 2",
                           "debian:bookworm-slim"})
    CHECK(meant(text) == text);
}
