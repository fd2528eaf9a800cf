#include "actors/cell/limits.hpp"
#include "actors/cell/tables/transfer_table.hpp"

#include "test/time_zero.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

struct open_transfer {
  transfer_table table{"lab", 7};
  std::string id = propose_and_open("arm");

  std::string propose_and_open(const std::string& node) {
    const auto result =
        table.propose(node, "uuid-of-" + node, "attic", 1).transfer;
    table.open(result);
    return result;
  }

  void switch_at(transfer_table::time_point now) {
    auto* x = table.find_open(id);
    REQUIRE(x);
    table.begin_switch(*x, table.switching_row(*x, 2), now);
  }
};

} // namespace

TEST_CASE("No two transfers of a cell have one id", "[transfer_table]") {
  transfer_table table{"lab", 7};
  const auto first = table.propose("arm", "a", "", 1).transfer;
  CHECK(first == "lab-7-1");
  CHECK(table.new_id() == "lab-7-2");
  CHECK(table.propose("leg", "b", "", 1).transfer == "lab-7-3");
}

TEST_CASE("A proposed transfer holds its node and is shown to nobody",
          "[transfer_table]") {
  transfer_table table{"lab", 7};
  const auto id = table.propose("arm", "a", "", 1).transfer;
  CHECK(table.holder_of("a") == id);
  CHECK(table.rows().empty());
  CHECK_FALSE(table.find_open(id));
  CHECK_FALSE(table.find_open_of("a"));
  CHECK(table.find_proposed(id));
}

TEST_CASE("A transfer that could not be kept leaves nothing",
          "[transfer_table]") {
  transfer_table table{"lab", 7};
  const auto id = table.propose("arm", "a", "", 1).transfer;
  table.find_proposed(id)->waiting.push_back(
      [](const cell_transfer&, const completion&) {});
  CHECK(table.withdraw(id).size() == 1);
  CHECK(table.holder_of("a").empty());
  CHECK(table.size() == 0);
  CHECK(table.withdraw(id).empty());
}

TEST_CASE_METHOD(open_transfer, "An open transfer is not withdrawn",
                 "[transfer_table]") {
  CHECK(table.withdraw(id).empty());
  CHECK(table.find_open(id));
  CHECK(table.find_open_of("uuid-of-arm") == table.find_open(id));
}

TEST_CASE_METHOD(open_transfer, "A transfer ends once", "[transfer_table]") {
  table.find_open(id)->waiting.push_back(
      [](const cell_transfer&, const completion&) {});
  const auto ended = table.end(id, transfer_state::returned, "it came back", 5);
  REQUIRE(ended);
  CHECK(ended->row.state == transfer_state::returned);
  CHECK(ended->row.reason == "it came back");
  CHECK(ended->row.since_unix_ms == 5);
  CHECK(ended->waiting.size() == 1);
  CHECK_FALSE(table.end(id, transfer_state::done, "", 6));
  CHECK_FALSE(table.find_open(id));
  CHECK(table.holder_of("uuid-of-arm").empty());
  REQUIRE(table.rows(id).size() == 1);
  CHECK(table.rows(id)[0].state == transfer_state::returned);
}

TEST_CASE_METHOD(open_transfer, "A node that was told to go has its time",
                 "[transfer_table]") {
  CHECK(table.next_deadline() == transfer_table::time_point::max());
  switch_at(time_zero);
  CHECK(table.next_deadline() == time_zero + limits::transfer::arrival);
  CHECK(table.overdue(time_zero + 24s).empty());
  CHECK(table.overdue(time_zero + 25s) == std::vector{id});
}

TEST_CASE_METHOD(open_transfer, "What is unresolved is open, and answered",
                 "[transfer_table]") {
  switch_at(time_zero);
  auto* x = table.find_open(id);
  x->waiting.push_back([](const cell_transfer&, const completion&) {});
  CHECK(table.set_unresolved(*x, "nothing is known", 9).size() == 1);
  CHECK(x->waiting.empty());
  CHECK(table.overdue(time_zero + 1h).empty());
  CHECK(table.next_deadline() == transfer_table::time_point::max());
  CHECK(table.holder_of("uuid-of-arm") == id);
  CHECK_FALSE(table.is_busy("uuid-of-arm"));
  table.propose("arm", "uuid-of-arm", "", 10);
  CHECK(table.is_busy("uuid-of-arm"));
  CHECK(table.find_open_of("uuid-of-arm") == table.find_open(id));
  CHECK(table.end(id, transfer_state::done, "", 10));
}

TEST_CASE_METHOD(open_transfer,
                 "Open transfers are remembered however many there are",
                 "[transfer_table]") {
  for (int i = 0; i < 300; ++i)
    propose_and_open("n" + std::to_string(i));
  CHECK(table.end(id, transfer_state::done, "", 1));
  CHECK(table.forget_oldest().empty());
  CHECK(table.rows(id).size() == 1);
  CHECK(table.rows().size() == 301);
}

TEST_CASE("The newest 100 ended transfers are remembered", "[transfer_table]") {
  open_transfer x;
  for (int i = 0; i < 105; ++i) {
    const auto id = x.propose_and_open("n" + std::to_string(i));
    REQUIRE(x.table.end(id, transfer_state::done, "", 10 + i));
  }
  CHECK(x.table.forget_oldest().size() == 5);
  CHECK(x.table.size() == 101);
  CHECK_FALSE(x.table.find_gone("n4"));
  CHECK(x.table.find_gone("n5"));
  CHECK(x.table.find_open(x.id));
}

TEST_CASE_METHOD(open_transfer,
                 "The last transfer that took a node away is remembered",
                 "[transfer_table]") {
  CHECK_FALSE(table.find_gone("arm"));
  REQUIRE(table.end(id, transfer_state::returned, "", 5));
  CHECK_FALSE(table.find_gone("arm"));
  const auto later = propose_and_open("arm");
  REQUIRE(table.end(later, transfer_state::done, "", 6));
  REQUIRE(table.find_gone("arm"));
  CHECK(table.find_gone("arm")->transfer == later);
}

TEST_CASE_METHOD(open_transfer, "A stored transfer is read as it was written",
                 "[transfer_table]") {
  switch_at(time_zero);
  const auto record = record_of(table.rows(id)[0]);
  CHECK(record.table == "transfers");
  CHECK(record.key == id);
  transfer_table later{"lab", 8};
  later.restore(json::parse(record.value).get<transfer_row>());
  REQUIRE(later.find_open_of("uuid-of-arm"));
  CHECK(later.find_open(id)->row.state == transfer_state::switching);
  CHECK(later.next_deadline() == transfer_table::time_point::max());
}

} // namespace roscell::test
