#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/limits.hpp"

#include <catch2/catch.hpp>

#include <string>

namespace roscell {

TEST_CASE("a name is as the schemas bound it") {
  for (const auto* text : {"a", "7", "arm-1", "Hall_2.east"})
    CHECK(is_name(text));
  for (const auto* text :
       {"", "-a", ".a", "_a", "a b", "a\n", "a/b", "\xc3\xbc"})
    CHECK_FALSE(is_name(text));
  CHECK(is_name(std::string(limits::text::name_bytes, 'a')));
  CHECK_FALSE(is_name(std::string(limits::text::name_bytes + 1, 'a')));
}

TEST_CASE("a UUID has hexadecimal digits and dashes only") {
  CHECK(is_uuid("0b9f2c1e-7a4d-4e0b-9C3F-1d2e3f4a5b6c"));
  for (const auto* text : {"", "g", "a b", "a\n"})
    CHECK_FALSE(is_uuid(text));
  CHECK(is_uuid(std::string(limits::text::uuid_bytes, 'a')));
  CHECK_FALSE(is_uuid(std::string(limits::text::uuid_bytes + 1, 'a')));
}

} // namespace roscell
