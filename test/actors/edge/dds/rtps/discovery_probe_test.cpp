#include "actors/edge/dds/rtps/discovery_probe.hpp"

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
