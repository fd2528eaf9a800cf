#include "actors/cell/limits.hpp"
#include "actors/cell/tables/slot_table.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

bool never_held(const std::string&) {
  return false;
}

} // namespace

TEST_CASE("A slot counts from the question on", "[slot_table]") {
  slot_table table;
  table.promise("arm", "c-1", time_zero);
  table.promise("leg", "c-1", time_zero);
  table.promise("eye", "c-2", time_zero);
  CHECK(table.count_at("c-1", never_held) == 2);
  CHECK(table.count_at("c-2", never_held) == 1);
  CHECK(table.count_at("c-3", never_held) == 0);
}

TEST_CASE("A slot that the cell has published counts once", "[slot_table]") {
  slot_table table;
  table.promise("arm", "c-1", time_zero);
  table.promise("leg", "c-1", time_zero);
  CHECK(table.count_at("c-1", [](const auto& node) { return node == "arm"; })
        == 1);
}

TEST_CASE("The same node gets the same place for 30 s", "[slot_table]") {
  slot_table table;
  CHECK(table.find("arm", time_zero).empty());
  table.promise("arm", "c-1", time_zero);
  CHECK(table.find("arm", time_zero + 29s) == "c-1");
  CHECK(table.find("arm", time_zero + 30s).empty());
  table.drop_overdue_slots(time_zero + 30s);
  CHECK(table.size() == 0);
}

TEST_CASE("A node has one place at a time", "[slot_table]") {
  slot_table table;
  table.promise("arm", "c-1", time_zero);
  table.promise("arm", "c-2", time_zero);
  CHECK(table.count_at("c-1", never_held) == 0);
  // The refusal of the first one comes late.
  table.forget("arm", "c-1");
  CHECK(table.find("arm", time_zero) == "c-2");
  table.forget("arm");
  CHECK(table.find("arm", time_zero).empty());
}

TEST_CASE("Unauthenticated peers fill no more places than a bound",
          "[slot_table]") {
  slot_table table;
  for (size_t i = 0; i <= limits::cell::places; ++i)
    table.promise("n" + std::to_string(i), "c-1",
                  time_zero + std::chrono::milliseconds{i});
  CHECK(table.size() == limits::cell::places);
  CHECK(table.find("n0", time_zero).empty());
  CHECK(table.find("n1", time_zero) == "c-1");
}

TEST_CASE("Who waits for a node hears of it once", "[slot_table]") {
  slot_table table;
  int calls = 0;
  const auto call = [&](const completion&) { ++calls; };
  CHECK(table.next_deadline() == slot_table::time_point::max());
  CHECK(table.await_arrival("arm", call, time_zero));
  CHECK(table.await_arrival("arm", call, time_zero));
  CHECK(table.await_arrival("leg", call, time_zero + 1s));
  for (const auto& x : table.take_arrivals("arm"))
    x.done({});
  CHECK(calls == 2);
  CHECK(table.take_arrivals("arm").empty());
  CHECK(table.next_deadline() == time_zero + 1s + limits::cell::arrival);
}

TEST_CASE("Nobody waits for a node for longer than 25 s", "[slot_table]") {
  slot_table table;
  const auto call = [](const completion&) {};
  table.await_arrival("arm", call, time_zero);
  table.await_arrival("leg", call, time_zero + 1s);
  CHECK(table.take_overdue_arrivals(time_zero + 24s).empty());
  CHECK(table.take_overdue_arrivals(time_zero + 25s).size() == 1);
  CHECK(table.take_arrivals("arm").empty());
  CHECK(table.take_arrivals("leg").size() == 1);
}

TEST_CASE("No more wait for a node than a bound", "[slot_table]") {
  slot_table table;
  const auto call = [](const completion&) {};
  for (size_t i = 0; i < limits::cell::waiting; ++i)
    REQUIRE(table.await_arrival("arm", call, time_zero));
  CHECK_FALSE(table.await_arrival("arm", call, time_zero));
  CHECK(table.take_arrivals("arm").size() == limits::cell::waiting);
}

TEST_CASE("Who waits for sizes waits for a moment", "[slot_table]") {
  slot_table table;
  int calls = 0;
  const auto call = [&] { ++calls; };
  CHECK(table.await_sizes(call, time_zero));
  CHECK(table.await_sizes(call, time_zero + 1s));
  CHECK(table.next_deadline() == time_zero + limits::cell::sizes);
  CHECK(table.take_overdue_who_await_sizes(time_zero + 1s).empty());
  CHECK(
      table.take_overdue_who_await_sizes(time_zero + limits::cell::sizes).size()
      == 1);
  for (const auto& x : table.take_all_who_await_sizes())
    x.done();
  CHECK(calls == 1);
  CHECK(table.next_deadline() == slot_table::time_point::max());
}

} // namespace roscell::test
