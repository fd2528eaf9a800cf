#include "schemas/base64.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

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
