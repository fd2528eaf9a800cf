#include "schemas/rules/schema_rule.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>
#include <string>

using namespace roscell;

TEST_CASE("a pattern matches the whole text") {
  text_pattern name{"^[A-Za-z0-9][A-Za-z0-9_.-]{0,3}$"};
  CHECK(name.matches("a"));
  CHECK(name.matches("0.-_"));
  CHECK_FALSE(name.matches(""));
  CHECK_FALSE(name.matches("-a"));
  CHECK_FALSE(name.matches("abcde"));
  CHECK_FALSE(name.matches("a b"));
  CHECK_FALSE(name.matches("a\n"));
}

TEST_CASE("counts bound how often a class repeats") {
  text_pattern exact{"^[0-9]{2}x{1,2}$"};
  CHECK(exact.matches("12x"));
  CHECK(exact.matches("12xx"));
  CHECK_FALSE(exact.matches("1x"));
  CHECK_FALSE(exact.matches("12"));
  CHECK_FALSE(exact.matches("12xxx"));
  CHECK(text_pattern{"^a*$"}.matches(""));
  CHECK(text_pattern{"^a*$"}.matches("aaa"));
  CHECK_FALSE(text_pattern{"^a+$"}.matches(""));
  CHECK(text_pattern{"^$"}.matches(""));
}

TEST_CASE("a class that overlaps with what follows gives way") {
  text_pattern address{"^[a-z.:]{1,20}:[0-9]{1,5}$"};
  CHECK(address.matches("a.b:80"));
  CHECK(address.matches("a::80"));
  CHECK_FALSE(address.matches("a.b:"));
}

TEST_CASE("a backslash takes the meaning from a character") {
  CHECK(text_pattern{"^\\.$"}.matches("."));
  CHECK_FALSE(text_pattern{"^\\.$"}.matches("a"));
  CHECK(text_pattern{"^[\\]a]$"}.matches("]"));
}

TEST_CASE("a negated class takes every other character, NUL by its number") {
  text_pattern no_nul{"^[^\\u0000]+$"};
  CHECK(no_nul.matches(u8"äöü €"));
  CHECK_FALSE(no_nul.matches(std::string{"a\0b", 3}));
}

TEST_CASE("characters are counted, not bytes") {
  CHECK(text_pattern{"^[^a]{3}$"}.matches(u8"ä€😀"));
  CHECK_FALSE(text_pattern{"^[^a]{2}$"}.matches(u8"ä€😀"));
}

TEST_CASE("a long text needs neither stack nor patience") {
  std::string text(1'000'000, 'a');
  CHECK(text_pattern{"^[^b]*$"}.matches(text));
  CHECK_FALSE(text_pattern{"^[^b]*b$"}.matches(text));
}

TEST_CASE("an expression outside of the subset is refused") {
  for (auto expression :
       {"",     "a",     "^a",   "a$",    "^(a)$",   "^a|b$",    "^.$",
        "^a?$", "^\\d$", "^[a$", "^a{2$", "^a{$",    "^a{1,}$",  "^a{1234567}$",
        "^*$",  "^\\$",  "^a$$", u8"^ä$", "^\\u00$", "^\\uzzzz$"}) {
    INFO(expression);
    CHECK_THROWS_AS(text_pattern{expression}, std::invalid_argument);
  }
}
