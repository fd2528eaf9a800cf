#include "actors/placement/search/group_search.hpp"

#include "random_cases.hpp"

#include "actors/placement/search/allocation.hpp"
#include "actors/placement/search/search.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

/// What both searches work on.
struct bench {
  explicit bench(const problem& given)
      : asked(given), candidates(find_candidates(asked, rejected)),
        empty(asked) {}

  problem asked;
  std::vector<rejected_candidate> rejected;
  candidate_set candidates;
  occupancy empty;
  search_space space{asked, candidates, empty};
};

/// Larger cells than a brute force can do: the nodes and steps of several
/// random cases, every second node with a twin.
oracle::instance joined(std::uint32_t seed, std::size_t nodes,
                        std::size_t steps) {
  oracle::instance all;
  while (all.machines.size() < nodes || all.tasks.size() < steps) {
    auto more = random_instance(++seed);
    for (const auto& machine : more.machines) {
      all.machines.push_back(machine);
      if (all.machines.size() % 2 == 1)
        all.machines.push_back(machine);
    }
    all.tasks.insert(all.tasks.end(), more.tasks.begin(), more.tasks.end());
  }
  all.machines.resize(nodes);
  all.tasks.resize(steps);
  for (auto& task : all.tasks)
    task.skill.assign(nodes, true);
  return all;
}

assignment depth_first(const search_space& space, const assignment& start,
                       watch& until) {
  lower_bound bound(space.asked, space.candidates, space.empty);
  search run(space, bound, start, until);
  run.minimise();
  run.settle_tie();
  return run.best();
}

std::vector<placement> depth_first(const bench& on) {
  auto start = greedy(on.space);
  if (!start)
    return {};
  limits none;
  watch until(none);
  return placements(on.space, depth_first(on.space, *start, until));
}

bool same(const std::vector<placement>& left,
          const std::vector<placement>& right) {
  return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                    [](const auto& x, const auto& y) {
                      return x.node == y.node && x.deployment == y.deployment
                             && x.gpu == y.gpu;
                    });
}

} // namespace

TEST_CASE("the depth-first search equals a brute force on random cases") {
  int compared = 0;
  for (std::uint32_t seed = 50'001; seed <= 50'600; ++seed) {
    INFO("seed " << seed);
    auto in = random_instance(seed);
    auto wanted = oracle::solve(in);
    if (!wanted.feasible)
      continue;
    auto made = depth_first(bench(translated(in)));
    if (made.empty())
      continue; // The greedy start has run out of room.
    ++compared;
    for (std::size_t i = 0; i < made.size(); ++i) {
      REQUIRE(static_cast<int>(made[i].node) == wanted.picks[i].v);
      REQUIRE(static_cast<int>(made[i].deployment) == wanted.picks[i].d);
      REQUIRE(made[i].gpu == wanted.picks[i].g);
    }
  }
  CHECK(compared > 200);
}

TEST_CASE("both searches agree where a brute force would take too long") {
  int compared = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    bench on(translated(joined(seed * 1000, 9, 7)));
    auto wanted = depth_first(on);
    if (wanted.empty())
      continue;
    ++compared;
    auto answer = allocate(on.asked);
    REQUIRE(answer.optimal());
    CHECK(same(answer.placements, wanted));
  }
  CHECK(compared > 20);
}

TEST_CASE("groups of equal nodes count once") {
  problem asked = translated(joined(7, 1, 3));
  asked.nodes.resize(1);
  for (int v = 1; v < 50; ++v) {
    asked.nodes.push_back(asked.nodes[0]);
    asked.nodes.back().name += "-" + std::to_string(v);
    for (auto& step : asked.steps)
      step.nodes_with_skill.insert(asked.nodes.back().name);
  }
  bench on(asked);
  limits none;
  watch until(none);
  auto many = find_groups(on.space, {-1, -1, -1}, 1e6, 100'000, until);
  REQUIRE(many);
  REQUIRE(many->kinds.size() == 1);
  CHECK(many->kinds[0].size() == 50);
  for (const auto& group : many->of)
    CHECK(group.kind == 0);
}

TEST_CASE("a list of groups that would be too long is given up") {
  bench on(translated(joined(11, 9, 7)));
  limits none;
  watch until(none);
  std::vector<double> least(7, -1);
  auto all = find_groups(on.space, least, 1e6, 1'000'000, until);
  REQUIRE(all);
  CHECK_FALSE(find_groups(on.space, least, 1e6, all->of.size() - 1, until));
}

TEST_CASE("more steps than a table of subsets can hold are still placed") {
  auto in = joined(5, 3, most_grouped_steps + 1);
  for (auto& machine : in.machines)
    machine.cpu = machine.mem = machine.disk = {1000, 0};
  for (auto& task : in.tasks)
    for (auto& way : task.ways) {
      way.archs.clear();
      way.tags.clear();
    }
  limits bounds;
  bounds.budget = std::chrono::seconds(1);
  auto answer = allocate(translated(in), bounds);
  REQUIRE(answer.has_allocation());
  CHECK(answer.placements.size() == most_grouped_steps + 1);
  CHECK(answer.lower_bound <= answer.value.total);
}
