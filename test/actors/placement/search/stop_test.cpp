#include "builders.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

/// Different nodes and steps, so that the proof takes many branches.
problem many() {
  problem asked;
  for (int v = 0; v < 12; ++v) {
    asked.nodes.push_back(make_node("node-" + std::to_string(v), 4 + v % 5,
                                    3000 + 170 * v, 9000 - 130 * v));
    asked.nodes.back().cpu.used = 0.1 * v;
    asked.nodes.back().memory_mib.used = 90 * (v % 7);
  }
  for (int i = 0; i < 6; ++i)
    add_step(asked, "step-" + std::to_string(i),
             {make_cpu(0.5 + 0.3 * i, 900 - 110 * i, 200 + 90 * i)});
  return asked;
}

limits stop_after(int& branches) {
  limits bounds;
  bounds.cancelled = [&branches] { return branches-- <= 0; };
  return bounds;
}

} // namespace

TEST_CASE("a stopped search answers with what it has and a proven bound") {
  auto asked = many();
  auto best = allocate(asked);
  REQUIRE(best.optimal());
  auto last_bound = -1.0;
  for (int after : {0, 10, 50, 200}) {
    REQUIRE(static_cast<std::size_t>(after) < best.expanded);
    int branches = after;
    auto answer = allocate(asked, stop_after(branches));
    REQUIRE(answer.what == outcome::best_found);
    CHECK_FALSE(answer.optimal());
    CHECK_FALSE(answer.message.empty());
    CHECK(answer.placements.size() == asked.steps.size());
    CHECK(answer.value.total >= best.value.total);
    CHECK(answer.lower_bound <= best.value.total + 1e-12);
    CHECK(answer.lower_bound >= last_bound - 1e-12);
    last_bound = answer.lower_bound;
  }
}

TEST_CASE("a search that is stopped at its very end has found the minimum") {
  auto asked = many();
  auto best = allocate(asked);
  auto branches = static_cast<int>(best.expanded) - 1;
  auto answer = allocate(asked, stop_after(branches));
  CHECK(answer.what == outcome::best_found);
  CHECK(answer.value.total <= best.value.total + 1e-12);
  CHECK(answer.lower_bound == answer.value.total);
}

TEST_CASE("a hook that never says stop changes nothing") {
  auto asked = many();
  limits bounds;
  bounds.cancelled = [] { return false; };
  bounds.budget = std::chrono::hours(1);
  auto answer = allocate(asked, bounds);
  CHECK(answer.optimal());
  CHECK(chosen(answer) == chosen(allocate(asked)));
}

TEST_CASE("the budget ends the search by the clock that was given") {
  auto asked = many();
  limits bounds;
  std::chrono::steady_clock::time_point clock;
  bounds.now = [&clock] { return clock += std::chrono::milliseconds(1); };
  bounds.budget = std::chrono::milliseconds(50);
  auto answer = allocate(asked, bounds);
  CHECK(answer.what == outcome::best_found);
  // The clock is read once at the start and once before each branch; once
  // out of time, what is left is only listed for the bound.
  CHECK(clock.time_since_epoch() <= std::chrono::milliseconds(60));
  bounds.budget = std::chrono::hours(100);
  CHECK(allocate(asked, bounds).optimal());
}

TEST_CASE("a budget of zero is no limit") {
  limits bounds;
  bounds.now = []() -> std::chrono::steady_clock::time_point {
    FAIL("the clock is not read without a budget");
    return {};
  };
  CHECK(allocate(many(), bounds).optimal());
}

TEST_CASE("a search that is stopped before anything fits is undecided") {
  problem asked;
  // The greedy start takes the second node for the first step, which leaves
  // no room for the second step there.
  asked.nodes = {make_node("a", 2, 400, 1000), make_node("b", 2, 200, 200)};
  add_step(asked, "first", {make_cpu(1, 100, 100)});
  add_step(asked, "second", {make_cpu(2, 100, 100)});
  asked.steps[1].nodes_with_skill = {"b"};
  int branches = 0;
  auto answer = allocate(asked, stop_after(branches));
  CHECK(answer.what == outcome::undecided);
  CHECK_FALSE(answer.has_allocation());
  CHECK(answer.placements.empty());
  CHECK(std::isfinite(answer.lower_bound));
  CHECK(answer.lower_bound <= allocate(asked).value.total);
  CHECK_FALSE(answer.message.empty());
}
