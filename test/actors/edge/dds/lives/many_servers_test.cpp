#include "actors/edge/dds/lives/discovery_guard.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include "test/actors/edge/dds/discovery_fixture.hpp"
#include "test/actors/edge/dds/lives/addressed.hpp"

#include <memory>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

using words = std::vector<std::uint8_t>;

constexpr std::uint8_t own_id = 3;
constexpr std::uint8_t other_id = 7;

struct one_of_many {
  discovery_guard guard{own_id, std::make_shared<number_reserve>(),
                        std::get<udp_socket>(udp_socket::bind("127.0.0.1", 0))};

  /// How many HEARTBEATs Fast DDS sees behind a message.
  std::size_t heartbeats_behind(words message) {
    auto sequel = guard.sequel_of(message.data(), message.size());
    std::size_t result = 0;
    if (sequel.empty())
      return result;
    CHECK(make_safe(sequel.data(), sequel.size()));
    CHECK(sender_of(sequel.data()) == sender_of(message.data()));
    for_each_submessage(sequel.data(), sequel.size(), [&](const auto& x) {
      result += static_cast<std::size_t>(x.kind == submessage_kind::heartbeat);
      return true;
    });
    return result;
  }

  /// Whether what this server tells of `who` goes to `to`.
  bool reports(const guid_prefix& who, const guid_prefix& to) {
    auto message = addressed(passed_on(who, own_id), to);
    return guard.let_out(message.data(), message.size());
  }
};

} // namespace

TEST_CASE_METHOD(one_of_many, "who gets to know a server hears at once of each "
                              "of its writers, and asks none") {
  const auto other = server_prefix(other_id);
  CHECK(heartbeats_behind(probe_question(other, {})) == 4);
  CHECK(heartbeats_behind(probe_reply(other, "")) == 4);
  CHECK(heartbeats_behind(probe_farewell(other)) == 0);
  CHECK(heartbeats_behind(probe_question(server_prefix(own_id), {})) == 0);
  const auto program = make_probe_prefix();
  CHECK(heartbeats_behind(probe_question(program, {})) == 0);
  CHECK(heartbeats_behind(passed_on(program, other_id)) == 0);
}

TEST_CASE_METHOD(one_of_many, "a server introduces itself to another one only "
                              "from time to time") {
  const auto self = server_prefix(own_id);
  const auto first = guard.lives().present(other_id);
  CHECK(reports(self, first));
  CHECK_FALSE(reports(self, first));
  CHECK(reports(make_probe_prefix(), first));
  CHECK(reports(self, server_prefix(other_id + 1)));
  const auto program = make_probe_prefix();
  CHECK(reports(self, program));
  CHECK(reports(self, program));
  guard.lose(other_id);
  CHECK_FALSE(reports(self, first));
  guard.lives().meet(other_id, {});
  CHECK(reports(self, guard.lives().present(other_id)));
}

TEST_CASE("an introduction that is put off is not lost") {
  diary seen;
  const auto cell = must_open(local_server(1, ""));
  auto options = local_server(2, "");
  options.remote = remote_server{"127.0.0.1", cell->port(), 1};
  const auto member = must_open(
      options, [&seen](const sighting& x) { seen.add(x.announcement); });
  cell->meet(2);
  member->meet(1);
  REQUIRE(seen.wait_for(""));
  for (int i = 1; i <= 20; ++i)
    REQUIRE_FALSE(cell->update_announcement(std::to_string(i)));
  CHECK(seen.wait_for("20"));
}
