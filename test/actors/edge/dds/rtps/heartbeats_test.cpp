#include "actors/edge/dds/rtps/heartbeats.hpp"

#include "actors/edge/dds/rtps/discovery_filter.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/submessages.hpp"

#include "test/actors/edge/dds/lives/addressed.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

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
