#include "actors/cell/books/transfer_book.hpp"

#include "actors/house/limits.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

struct open_transfer {
  transfer_book book{"lab", 7};
  std::string id = propose_and_open("arm");

  std::string propose_and_open(const std::string& node) {
    const auto result =
        book.propose(node, "uuid-of-" + node, "attic", 1).transfer;
    book.open(result);
    return result;
  }

  void switch_at(transfer_book::time_point now) {
    auto* x = book.find_open(id);
    REQUIRE(x);
    book.begin_switch(*x, book.switching_row(*x, 2), now);
  }
};

} // namespace

TEST_CASE("No two transfers of a cell have one id", "[transfer_book]") {
  transfer_book book{"lab", 7};
  const auto first = book.propose("arm", "a", "", 1).transfer;
  CHECK(first == "lab-7-1");
  CHECK(book.new_id() == "lab-7-2");
  CHECK(book.propose("leg", "b", "", 1).transfer == "lab-7-3");
}

TEST_CASE("A proposed transfer holds its node and is shown to nobody",
          "[transfer_book]") {
  transfer_book book{"lab", 7};
  const auto id = book.propose("arm", "a", "", 1).transfer;
  CHECK(book.holder_of("a") == id);
  CHECK(book.rows().empty());
  CHECK_FALSE(book.find_open(id));
  CHECK_FALSE(book.find_open_of("a"));
  CHECK(book.find_proposed(id));
}

TEST_CASE("A transfer that could not be kept leaves nothing",
          "[transfer_book]") {
  transfer_book book{"lab", 7};
  const auto id = book.propose("arm", "a", "", 1).transfer;
  book.find_proposed(id)->waiting.push_back(
      [](const cell_transfer&, const failure*) {});
  CHECK(book.withdraw(id).size() == 1);
  CHECK(book.holder_of("a").empty());
  CHECK(book.size() == 0);
  CHECK(book.withdraw(id).empty());
}

TEST_CASE_METHOD(open_transfer, "An open transfer is not withdrawn",
                 "[transfer_book]") {
  CHECK(book.withdraw(id).empty());
  CHECK(book.find_open(id));
  CHECK(book.find_open_of("uuid-of-arm") == book.find_open(id));
}

TEST_CASE_METHOD(open_transfer, "A transfer ends once", "[transfer_book]") {
  book.find_open(id)->waiting.push_back(
      [](const cell_transfer&, const failure*) {});
  const auto ended = book.end(id, transfer_state::returned, "it came back", 5);
  REQUIRE(ended);
  CHECK(ended->row.state == transfer_state::returned);
  CHECK(ended->row.reason == "it came back");
  CHECK(ended->row.since_unix_ms == 5);
  CHECK(ended->waiting.size() == 1);
  CHECK_FALSE(book.end(id, transfer_state::done, "", 6));
  CHECK_FALSE(book.find_open(id));
  CHECK(book.holder_of("uuid-of-arm").empty());
  REQUIRE(book.rows(id).size() == 1);
  CHECK(book.rows(id)[0].state == transfer_state::returned);
}

TEST_CASE_METHOD(open_transfer, "A node that was told to go has its time",
                 "[transfer_book]") {
  CHECK(book.next_deadline() == transfer_book::time_point::max());
  switch_at(time_zero);
  CHECK(book.next_deadline() == time_zero + limits::transfer::arrival);
  CHECK(book.overdue(time_zero + 24s).empty());
  CHECK(book.overdue(time_zero + 25s) == std::vector{id});
}

TEST_CASE_METHOD(open_transfer, "What is unresolved is open, and answered",
                 "[transfer_book]") {
  switch_at(time_zero);
  auto* x = book.find_open(id);
  x->waiting.push_back([](const cell_transfer&, const failure*) {});
  CHECK(book.set_unresolved(*x, "nothing is known", 9).size() == 1);
  CHECK(x->waiting.empty());
  CHECK(book.overdue(time_zero + 1h).empty());
  CHECK(book.next_deadline() == transfer_book::time_point::max());
  CHECK(book.holder_of("uuid-of-arm") == id);
  CHECK_FALSE(book.is_busy("uuid-of-arm"));
  book.propose("arm", "uuid-of-arm", "", 10);
  CHECK(book.is_busy("uuid-of-arm"));
  CHECK(book.find_open_of("uuid-of-arm") == book.find_open(id));
  CHECK(book.end(id, transfer_state::done, "", 10));
}

TEST_CASE_METHOD(open_transfer,
                 "Open transfers are remembered however many there are",
                 "[transfer_book]") {
  for (int i = 0; i < 300; ++i)
    propose_and_open("n" + std::to_string(i));
  CHECK(book.end(id, transfer_state::done, "", 1));
  CHECK(book.forget_oldest().empty());
  CHECK(book.rows(id).size() == 1);
  CHECK(book.rows().size() == 301);
}

TEST_CASE("The newest 100 ended transfers are remembered", "[transfer_book]") {
  open_transfer x;
  for (int i = 0; i < 105; ++i) {
    const auto id = x.propose_and_open("n" + std::to_string(i));
    REQUIRE(x.book.end(id, transfer_state::done, "", 10 + i));
  }
  CHECK(x.book.forget_oldest().size() == 5);
  CHECK(x.book.size() == 101);
  CHECK_FALSE(x.book.find_gone("n4"));
  CHECK(x.book.find_gone("n5"));
  CHECK(x.book.find_open(x.id));
}

TEST_CASE_METHOD(open_transfer,
                 "The last transfer that took a node away is remembered",
                 "[transfer_book]") {
  CHECK_FALSE(book.find_gone("arm"));
  REQUIRE(book.end(id, transfer_state::returned, "", 5));
  CHECK_FALSE(book.find_gone("arm"));
  const auto later = propose_and_open("arm");
  REQUIRE(book.end(later, transfer_state::done, "", 6));
  REQUIRE(book.find_gone("arm"));
  CHECK(book.find_gone("arm")->transfer == later);
}

TEST_CASE_METHOD(open_transfer, "A stored transfer is read as it was written",
                 "[transfer_book]") {
  switch_at(time_zero);
  const auto record = record_of(book.rows(id)[0]);
  CHECK(record.table == "transfers");
  CHECK(record.key == id);
  transfer_book later{"lab", 8};
  later.restore(json::parse(record.value).get<transfer_row>());
  REQUIRE(later.find_open_of("uuid-of-arm"));
  CHECK(later.find_open(id)->row.state == transfer_state::switching);
  CHECK(later.next_deadline() == transfer_book::time_point::max());
}

} // namespace roscell::test
