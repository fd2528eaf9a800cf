#include "actors/cell/books/place_book.hpp"

#include "actors/house/limits.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

bool never(const std::string&) {
  return false;
}

} // namespace

TEST_CASE("A place counts from the question on", "[place_book]") {
  place_book book;
  book.promise("arm", "c-1", time_zero);
  book.promise("leg", "c-1", time_zero);
  book.promise("eye", "c-2", time_zero);
  CHECK(book.count_at("c-1", never) == 2);
  CHECK(book.count_at("c-2", never) == 1);
  CHECK(book.count_at("c-3", never) == 0);
}

TEST_CASE("A place that the cell has told of counts once", "[place_book]") {
  place_book book;
  book.promise("arm", "c-1", time_zero);
  book.promise("leg", "c-1", time_zero);
  CHECK(book.count_at("c-1", [](const auto& node) { return node == "arm"; })
        == 1);
}

TEST_CASE("The same node gets the same place for 30 s", "[place_book]") {
  place_book book;
  CHECK(book.find("arm", time_zero).empty());
  book.promise("arm", "c-1", time_zero);
  CHECK(book.find("arm", time_zero + 29s) == "c-1");
  CHECK(book.find("arm", time_zero + 30s).empty());
  book.drop_overdue_places(time_zero + 30s);
  CHECK(book.size() == 0);
}

TEST_CASE("A node has one place at a time", "[place_book]") {
  place_book book;
  book.promise("arm", "c-1", time_zero);
  book.promise("arm", "c-2", time_zero);
  CHECK(book.count_at("c-1", never) == 0);
  // The refusal of the first one comes late.
  book.forget("arm", "c-1");
  CHECK(book.find("arm", time_zero) == "c-2");
  book.forget("arm");
  CHECK(book.find("arm", time_zero).empty());
}

TEST_CASE("Strangers fill no more places than a bound", "[place_book]") {
  place_book book;
  for (size_t i = 0; i <= limits::cell::places; ++i)
    book.promise("n" + std::to_string(i), "c-1",
                 time_zero + std::chrono::milliseconds{i});
  CHECK(book.size() == limits::cell::places);
  CHECK(book.find("n0", time_zero).empty());
  CHECK(book.find("n1", time_zero) == "c-1");
}

TEST_CASE("Who waits for a node hears of it once", "[place_book]") {
  place_book book;
  int calls = 0;
  const auto call = [&](const failure*) { ++calls; };
  CHECK(book.next_deadline() == place_book::time_point::max());
  CHECK(book.await_arrival("arm", call, time_zero));
  CHECK(book.await_arrival("arm", call, time_zero));
  CHECK(book.await_arrival("leg", call, time_zero + 1s));
  for (const auto& x : book.take_arrivals("arm"))
    x.done(nullptr);
  CHECK(calls == 2);
  CHECK(book.take_arrivals("arm").empty());
  CHECK(book.next_deadline() == time_zero + 1s + limits::cell::arrival);
}

TEST_CASE("Nobody waits for a node for longer than 25 s", "[place_book]") {
  place_book book;
  const auto call = [](const failure*) {};
  book.await_arrival("arm", call, time_zero);
  book.await_arrival("leg", call, time_zero + 1s);
  CHECK(book.take_overdue_arrivals(time_zero + 24s).empty());
  CHECK(book.take_overdue_arrivals(time_zero + 25s).size() == 1);
  CHECK(book.take_arrivals("arm").empty());
  CHECK(book.take_arrivals("leg").size() == 1);
}

TEST_CASE("No more wait for a node than a bound", "[place_book]") {
  place_book book;
  const auto call = [](const failure*) {};
  for (size_t i = 0; i < limits::cell::waiting; ++i)
    REQUIRE(book.await_arrival("arm", call, time_zero));
  CHECK_FALSE(book.await_arrival("arm", call, time_zero));
  CHECK(book.take_arrivals("arm").size() == limits::cell::waiting);
}

TEST_CASE("Who waits for sizes waits for a moment", "[place_book]") {
  place_book book;
  int calls = 0;
  const auto call = [&] { ++calls; };
  CHECK(book.await_sizes(call, time_zero));
  CHECK(book.await_sizes(call, time_zero + 1s));
  CHECK(book.next_deadline() == time_zero + limits::cell::sizes);
  CHECK(book.take_overdue_who_await_sizes(time_zero + 1s).empty());
  CHECK(
      book.take_overdue_who_await_sizes(time_zero + limits::cell::sizes).size()
      == 1);
  for (const auto& x : book.take_all_who_await_sizes())
    x.done();
  CHECK(calls == 1);
  CHECK(book.next_deadline() == place_book::time_point::max());
}

} // namespace roscell::test
