#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/bounds/lower_bound.hpp"
#include "builders.hpp"
#include "random_cases.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace roscell::allocation;
using namespace roscell::allocation::test;

namespace {

constexpr double rounding = 1e-11;

std::vector<candidate> fitting_candidates(const search_space& space,
                                          const occupancy& now,
                                          std::size_t step) {
  std::vector<candidate> fitting;
  for (const auto& choice : space.candidates.of[step])
    if (now.shares_of(space.way(step, choice), choice).fit())
      fitting.push_back(choice);
  return fitting;
}

/// One random way to place all steps, with the bounds seen along it.
class walk {
public:
  walk(const search_space& space, const lower_bound& bound)
      : space_(space), bound_(bound), now_(space.empty) {}

  /// False when a step found no room.
  bool run(std::mt19937& random) {
    double sum = 0;
    for (std::size_t i = 0; i < space_.steps(); ++i) {
      balances_.push_back(sum + bound_.balance(now_, i, i));
      loads_.push_back(bound_.load(now_, i));
      auto fitting = fitting_candidates(space_, now_, i);
      if (fitting.empty())
        return false;
      const auto& choice = fitting[random() % fitting.size()];
      const auto& way = space_.way(i, choice);
      sum += space_.cost(i, choice, now_.shares_of(way, choice));
      now_.place(way, choice);
    }
    sum_ = sum;
    return true;
  }

  void check() const {
    for (auto balance : balances_)
      REQUIRE(balance <= sum_ + rounding);
    for (auto load : loads_)
      REQUIRE(load <= now_.load_variance() + rounding);
    // With nothing open, the bounds are the score itself.
    REQUIRE(bound_.balance(now_, space_.steps(), space_.steps()) == 0);
    REQUIRE(bound_.load(now_, space_.steps())
            == Approx(now_.load_variance()).margin(rounding));
  }

private:
  const search_space& space_;
  const lower_bound& bound_;
  occupancy now_;
  std::vector<double> balances_;
  std::vector<double> loads_;
  double sum_ = 0;
};

/// Walks at random through a problem; returns how many found room for all.
int check_bounds(const problem& asked, std::size_t row_work,
                 std::mt19937& random) {
  std::vector<rejected_candidate> rejected;
  occupancy empty(asked);
  auto candidates = find_candidates(asked, rejected);
  search_space space{asked, candidates, empty};
  lower_bound bound(asked, candidates, empty, row_work);
  int complete = 0;
  for (int round = 0; round < 10; ++round) {
    walk one(space, bound);
    if (!one.run(random))
      continue;
    one.check();
    ++complete;
  }
  return complete;
}

/// More steps and nodes than a row of the bound holds.
oracle::instance large_instance(std::uint32_t seed) {
  oracle::instance all;
  while (all.machines.size() < 22 || all.tasks.size() < 20) {
    auto more = random_instance(++seed);
    all.machines.insert(all.machines.end(), more.machines.begin(),
                        more.machines.end());
    all.tasks.insert(all.tasks.end(), more.tasks.begin(), more.tasks.end());
  }
  for (auto& task : all.tasks)
    task.skill.assign(all.machines.size(), true);
  return all;
}

} // namespace

TEST_CASE("no way to place the open steps is below the lower bound") {
  std::mt19937 random(3);
  int complete = 0;
  for (std::uint32_t seed = 1; seed <= 1500; ++seed) {
    INFO("seed " << seed);
    complete += check_bounds(translated(random_instance(seed)),
                             seed % 2 == 0 ? 1 : 1'000'000, random);
  }
  CHECK(complete > 1500);
}

TEST_CASE("the lower bound holds where more nodes are used than a row holds") {
  std::mt19937 random(4);
  int complete = 0;
  for (std::uint32_t seed = 1; seed <= 400; seed += 20) {
    INFO("seed " << seed);
    complete += check_bounds(translated(large_instance(seed)),
                             seed % 40 == 1 ? 20'000 : 1'000'000, random);
  }
  CHECK(complete > 20);
}

TEST_CASE("the next step's bound is what it costs at its best node") {
  std::mt19937 random(5);
  for (std::uint32_t seed = 1; seed <= 500; ++seed) {
    INFO("seed " << seed);
    auto asked = translated(random_instance(seed));
    std::vector<rejected_candidate> rejected;
    occupancy now(asked);
    auto empty = now;
    auto candidates = find_candidates(asked, rejected);
    search_space space{asked, candidates, empty};
    lower_bound bound(asked, candidates, empty);
    for (std::size_t i = 0; i < space.steps(); ++i) {
      auto fitting = fitting_candidates(space, now, i);
      if (fitting.empty())
        break;
      auto least = std::numeric_limits<double>::infinity();
      for (const auto& choice : fitting)
        least = std::min(
            least,
            space.cost(i, choice, now.shares_of(space.way(i, choice), choice)));
      // The later steps are left out by asking for the last step alone.
      if (i + 1 == space.steps())
        REQUIRE(bound.balance(now, i, i) == Approx(least).margin(rounding));
      const auto& choice = fitting[random() % fitting.size()];
      now.place(space.way(i, choice), choice);
    }
  }
}

TEST_CASE("a node beyond the end of a full row still counts") {
  problem asked;
  for (int v = 0; v < 18; ++v)
    asked.nodes.push_back(
        make_node("node-" + std::to_string(v), 1, v < 16 ? 100 : 200, 100));
  for (int i = 0; i < 18; ++i)
    add_step(asked, "step-" + std::to_string(i), {make_cpu(1, 100, 100)});
  std::vector<rejected_candidate> rejected;
  occupancy now(asked);
  auto empty = now;
  auto candidates = find_candidates(asked, rejected);
  lower_bound bound(asked, candidates, empty);
  for (std::uint32_t v = 0; v < 16; ++v)
    now.place(asked.steps[v].deployments[0], {v, 0, -1});
  // Fractions 1, 1/2, 1 have variance 1/18, and there are two such steps.
  CHECK(bound.balance(now, 16, 16) <= 2.0 / 18 + rounding);
  CHECK(allocate(asked).optimal());
}
using roscell::allocation::interval;
using roscell::allocation::least_spread;

namespace {

double spread(const std::vector<interval>& of) {
  return least_spread(of.data(), of.size());
}

/// The same minimum by ternary search, since the sum is convex in t.
double searched(const std::vector<interval>& of) {
  auto sum = [&](double t) {
    double total = 0;
    for (const auto& one : of)
      total += std::pow(t - std::clamp(t, one.low, one.high), 2);
    return total;
  };
  double low = -10, high = 10;
  for (int round = 0; round < 200; ++round) {
    auto left = low + (high - low) / 3;
    auto right = high - (high - low) / 3;
    if (sum(left) < sum(right))
      high = right;
    else
      low = left;
  }
  return sum(low);
}

} // namespace

TEST_CASE("points have the sum of squared deviations from their mean") {
  CHECK(spread({}) == 0);
  CHECK(spread({{3, 3}}) == 0);
  CHECK(spread({{0, 0}, {1, 1}}) == Approx(0.5));
  // Mean 2: 4 + 1 + 9.
  CHECK(spread({{0, 0}, {1, 1}, {5, 5}}) == Approx(14));
}

TEST_CASE("intervals with a point in common have no spread") {
  CHECK(spread({{0, 2}, {1, 3}, {2, 2}}) == 0);
}

TEST_CASE("intervals apart have the spread of their nearest points") {
  CHECK(spread({{0, 1}, {3, 9}}) == Approx(2));
  // The middle one contains the mean of the others and adds nothing.
  CHECK(spread({{0, 1}, {1.5, 2.5}, {3, 9}}) == Approx(2));
}

TEST_CASE("the least spread of random intervals is the convex minimum") {
  std::mt19937 random(7);
  std::uniform_real_distribution<> place(-3, 3);
  std::uniform_int_distribution<> count(1, 9);
  std::uniform_int_distribution<> kind(0, 2);
  for (int round = 0; round < 2000; ++round) {
    std::vector<interval> of(static_cast<std::size_t>(count(random)));
    for (auto& one : of) {
      auto a = std::round(place(random) * 4) / 4;
      auto b = kind(random) == 0 ? a : place(random);
      one = {std::min(a, b), std::max(a, b)};
    }
    INFO("round " << round);
    REQUIRE(spread(of) == Approx(searched(of)).margin(1e-10));
  }
}
