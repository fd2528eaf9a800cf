#include "schemas/utf8.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace roscell;

namespace {

const std::string replaced = "\xEF\xBF\xBD";

} // namespace

TEST_CASE("valid text stays as it is") {
  for (const std::string text :
       {"", "plain", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\xA4\x96"})
    CHECK(valid_utf8(text) == text);
}

TEST_CASE("bytes that are no UTF-8 are replaced, the rest stays") {
  CHECK(valid_utf8("a\x80z") == "a" + replaced + "z");
  CHECK(valid_utf8("a\xFFz") == "a" + replaced + "z");
  // Cut, too long for its value, a surrogate, beyond the last code point.
  CHECK(valid_utf8("\xE2\x82") == replaced);
  CHECK(valid_utf8("\xC0\xAF") == replaced + replaced);
  CHECK(valid_utf8("\xED\xA0\x80") == replaced + replaced + replaced);
  CHECK(valid_utf8("\xF4\x90\x80\x80").find(replaced) == 0);
  CHECK(valid_utf8("\xE2z") == replaced + "z");
}

TEST_CASE("a character whose rest is missing is told from a broken one") {
  CHECK(unfinished_utf8("") == 0);
  CHECK(unfinished_utf8("a") == 0);
  CHECK(unfinished_utf8("\xC3\xA4") == 0);
  CHECK(unfinished_utf8("a\xC3") == 1);
  CHECK(unfinished_utf8("a\xE2\x82") == 2);
  CHECK(unfinished_utf8("a\xF0\x9F\xA4") == 3);
  CHECK(unfinished_utf8("a\x80") == 0);
  CHECK(unfinished_utf8("\xED\xA0") == 0);
}

TEST_CASE("base64 is that of RFC 4648") {
  const std::pair<const char*, const char*> known[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : known) {
    CHECK(to_base64(bytes) == text);
    CHECK(from_base64(text) == std::string{bytes});
  }
}

TEST_CASE("each byte comes back from base64") {
  std::string all;
  for (int x = 0; x < 256; ++x)
    all.push_back(static_cast<char>(x));
  CHECK(from_base64(to_base64(all)) == all);
}

TEST_CASE("what is no base64 gives nothing") {
  for (const auto* text : {"Zg=", "Z", "Zg==Zg==", "Zm9 ",
                           "Zm\xff=", "====", "Zm=v", "Zm9v====", "Z==="})
    CHECK_FALSE(from_base64(text));
}
