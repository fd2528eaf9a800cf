#include "actors/edge/dds/lives/discovery_guard.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "test/actors/edge/dds/discovery_fixture.hpp"
#include "test/actors/edge/dds/lives/addressed.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

using datagram = std::vector<std::uint8_t>;

constexpr std::uint8_t own_id = 3;
constexpr std::uint8_t reporter = 7;
constexpr std::uint8_t hearer = 8;

/// A server among others.
struct guarded {
  discovery_guard guard{own_id, std::make_shared<number_reserve>(),
                        std::get<udp_socket>(udp_socket::bind("127.0.0.1", 0))};

  /// How many HEARTBEATs Fast DDS sees behind a message.
  std::size_t heartbeats_behind(datagram message) {
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

  void hear(datagram what) {
    REQUIRE(guard.take_in(what.data(), what.size(), sockaddr_in{}));
  }

  /// What the wire gets.
  datagram report(const guid_prefix& who, std::uint8_t to) {
    auto result = addressed(passed_on(who, own_id), guard.lives().present(to));
    REQUIRE(guard.let_out(result.data(), result.size()));
    CHECK(make_safe(result.data(), result.size()));
    return result;
  }

  std::size_t reported(const guid_prefix& who, std::uint8_t to) {
    auto what = report(who, to);
    return participants_in(what.data(), what.size()).size();
  }
};

std::vector<submessage_kind> kinds_in(datagram what) {
  std::vector<submessage_kind> result;
  for_each_submessage(what.data(), what.size(), [&](const auto& x) {
    result.push_back(x.kind);
    return true;
  });
  return result;
}

} // namespace

TEST_CASE_METHOD(guarded, "who gets to know a server hears at once of each "
                          "of its writers, and asks none") {
  const auto other = server_prefix(reporter);
  CHECK(heartbeats_behind(probe_question(other, {})) == 4);
  CHECK(heartbeats_behind(probe_reply(other, "")) == 4);
  CHECK(heartbeats_behind(probe_farewell(other)) == 0);
  CHECK(heartbeats_behind(probe_question(server_prefix(own_id), {})) == 0);
  const auto program = make_probe_prefix();
  CHECK(heartbeats_behind(probe_question(program, {})) == 0);
  CHECK(heartbeats_behind(passed_on(program, reporter)) == 0);
}

TEST_CASE_METHOD(guarded, "a server introduces itself to another one only "
                          "from time to time") {
  const auto self = server_prefix(own_id);
  const auto first = guard.lives().present(reporter);
  CHECK(reports(self, first));
  CHECK_FALSE(reports(self, first));
  CHECK(reports(make_probe_prefix(), first));
  CHECK(reports(self, server_prefix(reporter + 1)));
  const auto program = make_probe_prefix();
  CHECK(reports(self, program));
  CHECK(reports(self, program));
  guard.lose(reporter);
  CHECK_FALSE(reports(self, first));
  guard.lives().meet(reporter, {});
  CHECK(reports(self, guard.lives().present(reporter)));
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

TEST_CASE_METHOD(guarded, "a server is not told of whom it has told of, in "
                          "whichever of its lives") {
  const auto who = make_probe_prefix();
  CHECK(reported(who, reporter) == 1);
  hear(passed_on(who, reporter));
  CHECK(reported(who, reporter) == 0);
  CHECK(reported(who, hearer) == 1);
  guard.lose(reporter);
  CHECK(reported(who, reporter) == 0);
  // Whoever speaks here is of this host now.
  hear(probe_question(who, {}));
  CHECK(reported(who, reporter) == 1);
}

TEST_CASE_METHOD(guarded, "what a server is not told is skipped by its number, "
                          "so that it is not asked for") {
  const auto who = make_probe_prefix();
  hear(passed_on(who, reporter));
  const auto what = report(who, reporter);
  const std::vector<submessage_kind> expected{
      submessage_kind::info_dst, submessage_kind::gap, submessage_kind::pad};
  CHECK(kinds_in(what) == expected);
  auto said = report(who, hearer);
  std::int64_t number = 0;
  for_each_submessage(said.data(), said.size(), [&](const auto& x) {
    auto at = x.body;
    if (x.kind == submessage_kind::data && at.skip(12))
      number = at.sequence_number();
    return true;
  });
  auto skipped = what;
  for_each_submessage(skipped.data(), skipped.size(), [&](const auto& x) {
    auto at = x.body;
    if (x.kind == submessage_kind::gap && at.skip(8)) {
      CHECK(at.sequence_number() == number);
      CHECK(at.sequence_number() == number + 1);
      CHECK(at.u32() == 0);
    }
    return true;
  });
}

TEST_CASE_METHOD(guarded, "an end is told to whoever has told of it") {
  const auto who = make_probe_prefix();
  hear(passed_on(who, reporter));
  auto what = addressed(death_notice(server_prefix(own_id), 5, who),
                        guard.lives().present(reporter));
  REQUIRE(guard.let_out(what.data(), what.size()));
  CHECK(participants_in(what.data(), what.size()).size() == 1);
}
