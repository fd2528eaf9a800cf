#include "actors/edge/session/heartbeat_packet.hpp"

#include <catch2/catch.hpp>

namespace roscell {

namespace {

const auto key = hmac_sha256("key", "of the test");

std::string bytes_of(const heartbeat_packet& packet, const digest& with = key) {
  const auto bytes = encode_heartbeat(packet, with);
  return {bytes.data(), bytes.size()};
}

} // namespace

TEST_CASE("a heartbeat has 16 bytes and says what was put in") {
  for (const auto kind :
       {heartbeat_kind::heartbeat, heartbeat_kind::ack, heartbeat_kind::probe})
    for (const uint32_t sequence : {0U, 1U, heartbeat_packet::max_sequence}) {
      const auto bytes = bytes_of({0xdeadbeef, kind, sequence});
      CHECK(bytes.size() == 16);
      const auto packet = read_heartbeat(bytes);
      REQUIRE(packet);
      CHECK(packet->tag == 0xdeadbeef);
      CHECK(packet->kind == kind);
      CHECK(packet->sequence == sequence);
      CHECK(is_authentic_heartbeat(bytes, key));
    }
}

TEST_CASE("the bytes of a heartbeat stand where the protocol says") {
  const auto bytes = bytes_of({0x01020304, heartbeat_kind::ack, 0x0a0b0c});
  CHECK(to_hex(bytes.substr(0, 8)) == "01020304200a0b0c");
  const auto mac = hmac_sha256(as_bytes(key), bytes.substr(0, 8));
  CHECK(bytes.substr(8) == as_bytes(mac).substr(0, 8));
}

TEST_CASE("a changed bit anywhere spoils a heartbeat") {
  const auto good = bytes_of({0x01020304, heartbeat_kind::heartbeat, 5});
  for (size_t i = 0; i < good.size() * 8; ++i) {
    auto bad = good;
    bad[i / 8] = static_cast<char>(bad[i / 8] ^ (1 << (i % 8)));
    CHECK_FALSE(is_authentic_heartbeat(bad, key));
  }
}

TEST_CASE("a heartbeat made with another key is not authentic") {
  const auto other = hmac_sha256("key", "of another session");
  CHECK_FALSE(is_authentic_heartbeat(
      bytes_of({1, heartbeat_kind::heartbeat, 1}, other), key));
}

TEST_CASE("what has another size or kind is no heartbeat") {
  const auto good = bytes_of({1, heartbeat_kind::heartbeat, 1});
  CHECK_FALSE(read_heartbeat(""));
  CHECK_FALSE(read_heartbeat(good.substr(1)));
  CHECK_FALSE(read_heartbeat(good + "x"));
  CHECK_FALSE(read_heartbeat(std::string(16, '\0')));
  CHECK_FALSE(read_heartbeat(std::string(16, '\xff')));
}

TEST_CASE("the tag is the beginning of the session id") {
  CHECK(heartbeat_tag("0123456789abcdef") == 0x01234567);
  CHECK(heartbeat_tag("") == 0);
}

} // namespace roscell
