#include "actors/edge/dds/limits.hpp"
#include "actors/edge/dds/presence_table.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

const presence_table::time_point start{100h};

guid_prefix prefix(std::size_t number) {
  guid_prefix result{};
  result[0] = static_cast<std::uint8_t>(number);
  result[1] = static_cast<std::uint8_t>(number >> 8);
  return result;
}

announcement coordinator(const std::string& uuid) {
  announcement result;
  result.role = "coordinator";
  result.node = "base";
  result.uuid = uuid;
  return result;
}

} // namespace

TEST_CASE("One participant is one announcement, whatever it says",
          "[presence_table]") {
  presence_table table;
  std::size_t seen = 0;
  std::size_t gone = 0;
  for (int i = 0; i < 1000; ++i)
    for (const auto& x :
         table.remember(prefix(1), coordinator(std::to_string(i)), start)
             .changes)
      ++(x.gone ? gone : seen);
  CHECK(table.size() == 1);
  CHECK(seen == 1000);
  CHECK(gone == 999);
}

TEST_CASE("More participants than a bound are not listened to",
          "[presence_table]") {
  presence_table table;
  for (std::size_t i = 0; i < limits::unauthenticated_peers::participants; ++i)
    CHECK(table.remember(prefix(i), coordinator(std::to_string(i)), start)
              .newcomer);
  const auto late =
      table.remember(prefix(5000), coordinator("late"), start + 1h);
  CHECK_FALSE(late.newcomer);
  CHECK(late.changes.empty());
  CHECK(table.size() == limits::unauthenticated_peers::participants);
  CHECK(table.forget(prefix(0), start + 1h).size() == 1);
  CHECK(table.remember(prefix(5000), coordinator("late"), start + 1h).newcomer);
}

TEST_CASE("What is repeated is told again, but seldom", "[presence_table]") {
  presence_table table;
  CHECK(table.remember(prefix(1), coordinator("a"), start).changes.size() == 1);
  CHECK(
      table.remember(prefix(1), coordinator("a"), start + 59s).changes.empty());
  CHECK(table.remember(prefix(1), coordinator("a"), start + 60s).changes.size()
        == 1);
  CHECK(
      table.remember(prefix(1), coordinator("a"), start + 61s).changes.empty());
}

TEST_CASE("A node that two participants announce is there until both have gone",
          "[presence_table]") {
  presence_table table;
  auto spoof = coordinator("a");
  spoof.session = "10.6.6.6:666";
  table.remember(prefix(1), coordinator("a"), start);
  table.remember(prefix(2), spoof, start);
  // What the true one says is told anew.
  const auto changes = table.forget(prefix(2), start);
  REQUIRE(changes.size() == 1);
  CHECK_FALSE(changes[0].gone);
  CHECK(changes[0].said == coordinator("a"));
  const auto end = table.forget(prefix(1), start);
  REQUIRE(end.size() == 1);
  CHECK(end[0].gone);
  CHECK(table.forget(prefix(1), start).empty());
}

} // namespace roscell::test
