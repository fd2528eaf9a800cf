#include "actors/instances/limits.hpp"
#include "actors/node/limits.hpp"
#include "actors/node/reservation_table.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

instance_spec spec_of(const std::string& task, const std::string& instance) {
  instance_spec result;
  result.task = task;
  result.instance = instance;
  return result;
}

std::vector<std::string> names(const std::vector<instance_spec>& specs) {
  std::vector<std::string> result;
  for (const auto& x : specs)
    result.push_back(x.instance);
  return result;
}

using words = std::vector<std::string>;

} // namespace

TEST_CASE("Room is kept until an instance is known", "[reservation_table]") {
  reservation_table reservations;
  CHECK_FALSE(reservations.keep(spec_of("t", "t-a-1"), time_zero));
  CHECK_FALSE(reservations.keep(spec_of("t", "t-b-1"), time_zero));
  CHECK(names(reservations.open(time_zero, {})) == words{"t-a-1", "t-b-1"});
  CHECK(names(reservations.open(time_zero, {"t-a-1"})) == words{"t-b-1"});
}

TEST_CASE("Room is kept for the time of a reservation", "[reservation_table]") {
  using std::chrono::milliseconds;
  reservation_table reservations;
  CHECK_FALSE(reservations.keep(spec_of("t", "t-a-1"), time_zero));
  const auto end = time_zero + limits::task::longest_reservation;
  CHECK(reservations.open(end - milliseconds{1}, {}).size() == 1);
  CHECK(reservations.open(end, {}).empty());
  CHECK(reservations.size() == 0);
}

TEST_CASE("A reservation that is repeated counts once and anew",
          "[reservation_table]") {
  reservation_table reservations;
  const auto later =
      time_zero
      + std::chrono::milliseconds{limits::task::longest_reservation} / 2;
  CHECK_FALSE(reservations.keep(spec_of("t", "t-a-1"), time_zero));
  CHECK_FALSE(reservations.keep(spec_of("t", "t-a-1"), later));
  CHECK(reservations.size() == 1);
  CHECK(reservations.open(time_zero + limits::task::longest_reservation, {})
            .size()
        == 1);
}

TEST_CASE("A task's room is given up as a whole or for one instance",
          "[reservation_table]") {
  reservation_table reservations;
  for (const auto* instance : {"t-a-1", "t-b-1"})
    CHECK_FALSE(reservations.keep(spec_of("t", instance), time_zero));
  CHECK_FALSE(reservations.keep(spec_of("u", "u-a-1"), time_zero));
  reservations.give_up("t", "t-b-1");
  reservations.give_up("t", "u-a-1");
  CHECK(names(reservations.open(time_zero, {})) == words{"t-a-1", "u-a-1"});
  reservations.give_up("t", "");
  CHECK(names(reservations.open(time_zero, {})) == words{"u-a-1"});
}

TEST_CASE("Room is kept for no more instances than a node runs",
          "[reservation_table]") {
  reservation_table reservations;
  for (size_t i = 0; i < limits::instance::most; ++i)
    CHECK_FALSE(reservations.keep(spec_of("t", std::to_string(i)), time_zero));
  CHECK(reservations.keep(spec_of("t", "one more"), time_zero));
  CHECK_FALSE(reservations.keep(spec_of("t", "0"), time_zero));
  const auto later = time_zero + limits::task::longest_reservation;
  CHECK_FALSE(reservations.keep(spec_of("t", "one more"), later));
}

} // namespace roscell::test
