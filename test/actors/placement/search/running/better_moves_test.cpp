#include "actors/placement/search/running/better_moves.hpp"

#include "../builders.hpp"
#include "../random_cases.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

constexpr move_request all_moves{1e-9, 100};

std::vector<seat> seats_of(const result& answer) {
  std::vector<seat> found;
  for (const auto& x : answer.placements)
    found.push_back({x.node, x.deployment, x.gpu});
  return found;
}

/// The total of steps that sit there: what is left when no other place may be
/// taken.
double total_of(problem asked, const std::vector<seat>& seats) {
  for (std::size_t i = 0; i < asked.steps.size(); ++i)
    for (std::size_t v = 0; v < asked.nodes.size(); ++v)
      for (std::size_t d = 0; d < asked.steps[i].deployments.size(); ++d) {
        std::vector<int> gpus{-1};
        for (const auto& card : asked.nodes[v].gpus)
          gpus.push_back(card.index);
        for (const auto gpu : gpus)
          if (v != seats[i].node || d != seats[i].deployment
              || gpu != seats[i].gpu)
            asked.excluded.push_back({i, v, d, gpu, "not there", false});
      }
  return allocate(asked).value.total;
}

/// Two steps on one of two equal nodes.
problem two_nodes() {
  problem result;
  for (const auto* name : {"a", "b"})
    result.nodes.push_back(make_node(name, 8, 100, 100));
  add_step(result, "s", {make_cpu(4, 10, 10)});
  add_step(result, "t", {make_cpu(4, 10, 10)});
  return result;
}

} // namespace

TEST_CASE("A step moves to where the total is better", "[better_moves]") {
  const auto asked = two_nodes();
  const auto found = better_moves(asked, {{0, 0, -1}, {0, 0, -1}}, all_moves);
  REQUIRE(found.moves.size() == 1);
  CHECK(found.moves[0].to.node == 1);
  CHECK(found.moves[0].gain == Approx(found.before.total - found.after.total));
  CHECK(found.optimal);
}

TEST_CASE("A move that gains too little is not made", "[better_moves]") {
  const auto asked = two_nodes();
  const std::vector<seat> now{{0, 0, -1}, {0, 0, -1}};
  const auto one = better_moves(asked, now, all_moves);
  const auto part = one.moves.at(0).gain / one.before.total;
  CHECK(better_moves(asked, now, {part * 0.99, 100}).moves.size() == 1);
  CHECK(better_moves(asked, now, {part * 1.01, 100}).moves.empty());
}

TEST_CASE("Steps that share files stay together", "[better_moves]") {
  auto asked = two_nodes();
  for (auto& x : asked.steps)
    x.together = 1;
  CHECK(better_moves(asked, {{0, 0, -1}, {0, 0, -1}}, all_moves).moves.empty());
}

TEST_CASE("A step that could not be placed where it runs is named",
          "[better_moves]") {
  auto asked = two_nodes();
  asked.steps[1].nodes_with_skill = {"b"};
  CHECK(misplaced(asked, {{0, 0, -1}, {0, 0, -1}})
        == std::vector<std::size_t>{1});
}

TEST_CASE("Moves gain what they say, and end at no less than the optimum",
          "[better_moves][random]") {
  int moved = 0;
  for (int seed = 0; seed < case_count(400); ++seed) {
    const auto asked =
        translated(random_instance(static_cast<std::uint32_t>(seed)));
    auto otherwise = asked;
    otherwise.alpha = 10;
    otherwise.gpu_bonus = 1;
    const auto start = allocate(otherwise);
    if (!start.has_allocation())
      continue;
    auto seats = seats_of(start);
    const auto found = better_moves(asked, seats, all_moves);
    const auto optimum = allocate(asked).value.total;
    INFO("seed " << seed);
    REQUIRE(found.before.total == Approx(total_of(asked, seats)).margin(1e-9));
    auto total = found.before.total;
    for (const auto& x : found.moves) {
      seats[x.step] = x.to;
      const auto after = total_of(asked, seats);
      REQUIRE(x.gain == Approx(total - after).margin(1e-9));
      REQUIRE(x.gain > 0);
      total = after;
      ++moved;
    }
    REQUIRE(found.after.total == Approx(total).margin(1e-9));
    REQUIRE(total >= optimum - 1e-9);
    REQUIRE(found.optimal == (total <= optimum + 1e-9));
    REQUIRE(found.lower_bound == Approx(optimum).margin(1e-9));
  }
  CHECK(moved > 20);
}
