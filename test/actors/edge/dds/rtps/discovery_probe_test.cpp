#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"
#include "test/actors/edge/dds/lives/addressed.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("a server's id is in its GUID prefix", "[discovery]") {
  for (int id : {0, 3, 255}) {
    auto prefix = server_prefix(static_cast<std::uint8_t>(id));
    CHECK(server_id_of(prefix) == id);
  }
  CHECK(to_text(server_prefix(0xab)) == "44.53.ab.5f.45.50.52.4f.53.49.4d.41");
}

TEST_CASE("another prefix has no server id", "[discovery]") {
  auto prefix = server_prefix(3);
  prefix[11] = 0;
  CHECK_FALSE(server_id_of(prefix));
  CHECK_FALSE(server_id_of(make_probe_prefix()));
}

TEST_CASE("every question has another asker", "[discovery]") {
  CHECK(make_probe_prefix() != make_probe_prefix());
}

TEST_CASE("an answer is any RTPS datagram and names its sender",
          "[discovery]") {
  auto self = make_probe_prefix();
  for (auto& bytes :
       {probe_question(self, sockaddr_in{}), probe_farewell(self)})
    CHECK(probe_answer(bytes.data(), bytes.size()) == self);
}

TEST_CASE("what is no RTPS datagram is no answer", "[discovery]") {
  auto bytes = probe_farewell(make_probe_prefix());
  for (std::size_t size = 0; size < 20; ++size)
    CHECK_FALSE(probe_answer(bytes.data(), size));
  bytes[0] = 'X';
  CHECK_FALSE(probe_answer(bytes.data(), bytes.size()));
}

TEST_CASE("who is told that there is something asks for all of it, and of "
          "nothing for nothing",
          "[discovery]") {
  const auto self = make_probe_prefix();
  // The first of these HEARTBEATs is of the participants' writer, as numbers
  // its first and its last behind the two entities.
  auto heard = test::addressed(first_heartbeats(server_prefix(3)), self);
  constexpr std::size_t numbers_at = rtps_header_bytes + 16 + 4 + 8;
  const auto answer = [&heard](const guid_prefix& to) {
    return heartbeat_answer(to, 1, heard.data(), heard.size());
  };
  CHECK(answer(self).empty());
  heard[numbers_at + 4] = 5;
  heard[numbers_at + 12] = 7;
  CHECK(answer(make_probe_prefix()).empty());
  auto asks = answer(self);
  REQUIRE(make_safe(asks.data(), asks.size()));
  CHECK(probe_answer(asks.data(), asks.size()) == self);
  for_each_submessage(asks.data(), asks.size(), [](const auto& x) {
    auto in = x.body;
    if (x.kind == submessage_kind::acknack && in.skip(8)) {
      CHECK(in.sequence_number() == 5);
      CHECK(in.u32() == 3);
      CHECK(in.u32() == 0xe0000000);
    }
    return true;
  });
  heard.resize(heard.size() - 5);
  CHECK_NOTHROW(answer(self));
}
