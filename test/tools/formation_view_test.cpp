#include "tools/roscell/view/plan_view.hpp"

#include "test/printed_text.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using roscell::test::cells_in;

namespace {

formation_outcome failed(const char* node, const char* hint) {
  return {node,           formation_result::failed, "",
          "unknown_node", "no node is visible",     hint};
}

} // namespace

TEST_CASE("a formation has a row for each name, with code and message",
          "[tools]") {
  formation_outcome moved;
  moved.node = "arm-1";
  moved.result = formation_result::joined;
  moved.from = "hall";
  const cell_formed formed{"lab", {moved, failed("x", "start it")}};
  CHECK(cells_in(formation_view(formed, {}))
        == "NODE|RESULT|FROM|MESSAGE\n"
           "arm-1|joined|hall|-\n"
           "x|failed|-|no node is visible (unknown_node)\n");
}

TEST_CASE("the hints of a formation are given once each", "[tools]") {
  const cell_formed formed{"lab",
                           {failed("x", "start it"), failed("y", ""),
                            failed("z", "start it"), failed("w", "wait")}};
  CHECK(hints_of(formed) == std::vector<std::string>{"start it", "wait"});
}

TEST_CASE("a move tells of the tasks that it cost", "[tools]") {
  CHECK(cells_in(transferred_view(
            {"arm-1", "lab", "hall", "lab-3-1", {"a", "b"}, {}}, {}))
        == "NODE|FROM|TO|TRANSFER|TASKS TERMINATED|TASKS RESCHEDULED\n"
           "arm-1|lab|hall|lab-3-1|a,b|-\n");
}

TEST_CASE("a released node goes to no cell", "[tools]") {
  CHECK(cells_in(released_view({"arm-1", "lab", "lab-3-2", {}, {"t"}}, {}))
        == "NODE|FROM|TO|TRANSFER|TASKS TERMINATED|TASKS RESCHEDULED\n"
           "arm-1|lab|(independent)|lab-3-2|-|t\n");
}

TEST_CASE("a transfer's id is the first column", "[tools]") {
  // The bash completion takes it from there.
  const transfer_description transfers{
      {{"lab-3-1", "arm-1", "u", "lab", "hall", transfer_state::returned,
        "no route", 1000}}};
  CHECK(cells_in(transfers_view(transfers, {{}, 61000}))
        == "TRANSFER|NODE|FROM|TO|STATE|SINCE|REASON\n"
           "lab-3-1|arm-1|lab|hall|returned|1m00s|no route\n");
  CHECK(transfers_view({}, {}) == "no transfers\n");
}
