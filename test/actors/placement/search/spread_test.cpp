#include "actors/placement/search/bounds/spread.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

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
