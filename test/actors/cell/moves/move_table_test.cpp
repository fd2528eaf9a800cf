#include "actors/cell/moves/move_table.hpp"
#include "actors/core/answer_limits.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

move_table::time_point noon() {
  return move_table::time_point{12h};
}

moving_step step_of_move(const std::string& step, bool ends_first,
                         uint64_t together = 0) {
  moving_step result;
  result.task = "t";
  result.step = step;
  result.node = "left";
  result.ends_first = ends_first;
  result.together = together;
  return result;
}

using positions = std::vector<size_t>;

} // namespace

TEST_CASE("A move goes in waves, what has to end first one by one",
          "[move_table]") {
  move_table x;
  const auto id = x.begin({step_of_move("a", true), step_of_move("b", false),
                           step_of_move("c", true), step_of_move("d", false)},
                          true);
  CHECK(x.at(id, move_stage::placed).size() == 4);
  CHECK(x.open_wave(id) == positions{1, 3});
  CHECK(x.open_wave(id) == positions{0});
  CHECK(x.open_wave(id) == positions{2});
  CHECK(x.open_wave(id).empty());
  x.end(id);
  CHECK(x.size() == 0);
  CHECK(x.open_wave(id).empty());
}

TEST_CASE("What shares files with a step that ends first ends with it",
          "[move_table]") {
  move_table x;
  const auto id =
      x.begin({step_of_move("a", false, 1), step_of_move("b", true, 1),
               step_of_move("c", false, 2), step_of_move("d", false)},
              true);
  CHECK(x.ends_first(id, 0));
  CHECK_FALSE(x.ends_first(id, 2));
  CHECK(x.open_wave(id) == positions{2, 3});
  CHECK(x.open_wave(id) == positions{0, 1});
}

TEST_CASE("A move that is no departure has one wave", "[move_table]") {
  move_table x;
  const auto id =
      x.begin({step_of_move("a", true), step_of_move("b", false)}, false);
  CHECK(x.open_wave(id) == positions{0, 1});
  CHECK(x.open_wave(id).empty());
}

TEST_CASE("What is over before its wave is not begun", "[move_table]") {
  move_table x;
  const auto id = x.begin({step_of_move("a", false), step_of_move("b", true),
                           step_of_move("c", true)},
                          true);
  REQUIRE(x.open_wave(id) == positions{0});
  CHECK(x.enter(id, 1, move_stage::over, noon()));
  CHECK(x.open_wave(id) == positions{2});
}

TEST_CASE("Nothing goes on with a step that has come to its end",
          "[move_table]") {
  const auto last =
      GENERATE(move_stage::moved, move_stage::over, move_stage::undone);
  move_table x;
  const auto id = x.begin({step_of_move("a", false)}, true);
  REQUIRE(x.enter(id, 0, last, noon()));
  CHECK_FALSE(x.enter(id, 0, move_stage::starting, noon()));
  CHECK(x.is_at(id, 0, last));
  CHECK_FALSE(x.enter(id + 1, 0, move_stage::up, noon()));
  CHECK_FALSE(x.enter(id, 1, move_stage::up, noon()));
}

TEST_CASE("Whatever is waited for has a deadline, and says what it is",
          "[move_table]") {
  move_table x;
  const auto id = x.begin({step_of_move("a", true)}, true);
  CHECK(x.waits_on("left").empty());
  x.enter(id, 0, move_stage::ordered, noon());
  x.enter(id, 0, move_stage::ending, noon() + 1s);
  CHECK(x.deadline_of(id, 0) == noon() + limits::task::eviction);
  CHECK(x.waits_on("left")
        == "'t/a' on node 'left' to be stop-safe and to end");
  CHECK(x.waits_on("right").empty());
  x.enter(id, 0, move_stage::starting, noon());
  CHECK(x.deadline_of(id, 0) == noon() + limits::task::deployment);
  CHECK(x.waits_on("left") == "'t/a' to run on its new node");
  x.enter(id, 0, move_stage::up, noon());
  CHECK(x.waits_on("left").empty());
}

} // namespace roscell::test
