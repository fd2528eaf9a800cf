#include "actors/edge/trust/sealed_text.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE(
    "a sealed text comes back to who has the secret, and to nobody else") {
  for (const std::string text : {"", "x", "a key and a certificate"}) {
    const auto sealed = seal_text("secret", text);
    CHECK(open_sealed("secret", sealed) == text);
    CHECK(seal_text("secret", text) != sealed);
    CHECK_FALSE(open_sealed("other", sealed));
    // Each byte counts, and so does its end.
    for (size_t i = 0; i < sealed.size(); ++i) {
      auto bad = sealed;
      bad[i] = static_cast<char>(bad[i] ^ 1);
      CHECK_FALSE(open_sealed("secret", bad));
      CHECK_FALSE(open_sealed("secret", sealed.substr(0, i)));
    }
  }
}
