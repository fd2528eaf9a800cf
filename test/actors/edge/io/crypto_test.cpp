#include "actors/edge/io/crypto.hpp"

#include <catch2/catch.hpp>

#include <set>

namespace roscell {

TEST_CASE("HMAC-SHA256 gives the digests of RFC 4231") {
  CHECK(to_hex(hmac_sha256(std::string(20, '\x0b'), "Hi There"))
        == "b0344c61d8db38535ca8afceaf0bf12b"
           "881dc200c9833da726e9376c2e32cff7");
  CHECK(to_hex(hmac_sha256("Jefe", "what do ya want for nothing?"))
        == "5bdcc146bf60754e6a042426089575c7"
           "5a003f089d2739839dec58b964ec3843");
  CHECK(to_hex(hmac_sha256(std::string(131, '\xaa'),
                           "Test Using Larger Than Block-Size Key - Hash Key "
                           "First"))
        == "60e431591ee0b67f0d8a26aacbf5b77f"
           "8e0bc6213728c5140546040f0ee37f54");
}

TEST_CASE("an empty key is a key, not the key of the call before") {
  const auto before = hmac_sha256("Jefe", "x");
  CHECK(hmac_sha256({}, "x") != before);
  CHECK(hmac_sha256({}, "x") == hmac_sha256("", "x"));
}

TEST_CASE("hexadecimal text becomes bytes and back") {
  CHECK(to_hex(std::string_view{"\x00\x7f\xff", 3}) == "007fff");
  CHECK(from_hex("007FfF") == std::string("\x00\x7f\xff", 3));
  CHECK(from_hex("") == std::string{});
  CHECK_FALSE(from_hex("abc"));
  CHECK_FALSE(from_hex("0g"));
  CHECK_FALSE(from_hex("0x"));
}

TEST_CASE("texts are equal in constant time if all their bytes are") {
  CHECK(equal_in_constant_time("", ""));
  CHECK(equal_in_constant_time("secret", "secret"));
  CHECK_FALSE(equal_in_constant_time("secret", "secreT"));
  CHECK_FALSE(equal_in_constant_time("secret", "secret2"));
  CHECK_FALSE(equal_in_constant_time("secret", ""));
}

TEST_CASE("random bytes do not repeat") {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i)
    seen.insert(random_bytes(16));
  CHECK(seen.size() == 100);
  CHECK(seen.begin()->size() == 16);
}

} // namespace roscell
