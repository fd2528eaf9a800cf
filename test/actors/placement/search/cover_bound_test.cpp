#include "actors/placement/search/bounds/slice_bound.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <random>

using namespace roscell::allocation;

namespace {

using weights = std::map<step_set, double>;

/// By its definition: every choice of sets, each no larger than the one before
/// so that none is counted twice.
double least_of_all(const weights& of, std::size_t count, step_set open,
                    step_set below) {
  if (count == 0)
    return open == 0 ? 0 : infinity;
  double least = infinity;
  for (const auto& [set, weight] : of)
    if (set < below && (set & ~open) == 0)
      least = std::min(least,
                       weight + least_of_all(of, count - 1, open ^ set, set));
  return least;
}

weights random_weights(std::mt19937& random, std::size_t steps) {
  weights made;
  for (step_set set = 1; set < step_set{1} << steps; ++set)
    if (random() % 3 > 0)
      made[set] = std::uniform_real_distribution<>(-1, 1)(random);
  return made;
}

} // namespace

TEST_CASE("the cover bound is the least of all choices of disjoint sets") {
  std::mt19937 random(1);
  for (std::size_t steps = 1; steps <= 5; ++steps)
    for (int round = 0; round < 20; ++round) {
      auto given = random_weights(random, steps);
      auto count = 1 + random() % steps;
      cover_bound bound(steps);
      bound.begin(count);
      for (const auto& [set, weight] : given)
        CHECK(bound.offer(set, weight));
      bound.finish();
      bound.finish_rest();
      const step_set all = (step_set{1} << steps) - 1;
      auto wanted = least_of_all(given, count, all, all + 1);
      if (wanted == infinity) {
        CHECK(bound.least(count, all) == infinity);
        continue;
      }
      CHECK(bound.least(count, all) == Approx(wanted).margin(1e-12));
      // A set and the best of what it leaves.
      for (const auto& [set, weight] : given) {
        auto rest = least_of_all(given, count - 1, all ^ set, all + 1);
        if (rest < infinity)
          CHECK(bound.least(count - 1, all ^ set)
                == Approx(rest).margin(1e-12));
      }
    }
}

TEST_CASE("the cheapest sets weigh what the cover bound says") {
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    auto given = random_weights(random, 6);
    cover_bound bound(6);
    bound.begin(3);
    for (const auto& [set, weight] : given)
      bound.offer(set, weight);
    bound.finish();
    if (bound.least(3, 63) == infinity)
      continue;
    double sum = 0;
    step_set covered = 0;
    auto sets = bound.cheapest(3, 63);
    REQUIRE(sets.size() == 3);
    for (auto set : sets) {
      CHECK((covered & set) == 0);
      covered |= set;
      sum += given.at(set);
    }
    CHECK(covered == 63);
    CHECK(sum == Approx(bound.least(3, 63)).margin(1e-12));
  }
}

TEST_CASE("only the lightest of several groups of the same steps counts") {
  cover_bound bound(2);
  bound.begin(1);
  CHECK(bound.offer(3, 2));
  CHECK_FALSE(bound.offer(3, 3));
  CHECK(bound.offer(3, 1));
  bound.finish();
  CHECK(bound.least(1, 3) == 1);
}
