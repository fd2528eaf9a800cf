#include "actors/allocation/first_guess.hpp"

#include <limits>

namespace roscell::allocation {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The score so far if the step were placed like this as well; infinite when
/// it does not fit.
double tried(const search_space& space, occupancy& now, double sum,
             std::size_t step, const candidate& choice) {
  const auto& way = space.way(step, choice);
  auto all = now.shares_of(way, choice);
  if (!all.fit())
    return infinity;
  auto before = now.place(way, choice);
  auto value = score_of(space, sum + space.cost(step, choice, all), now);
  now.restore(choice, before);
  return value.total;
}

/// The best move of one step, made if it helps.
bool move_one(const search_space& space, assignment& guess, double& total,
              occupancy& scratch, watch& until) {
  auto best = guess;
  auto before = total;
  for (std::size_t i = 0; i < guess.size(); ++i) {
    auto trial = guess;
    for (trial[i] = 0; trial[i] < space.candidates.of[i].size(); ++trial[i]) {
      if (until.must_stop())
        return false;
      auto value = evaluate(space, trial, scratch);
      if (value && value->total < total) {
        total = value->total;
        best = trial;
      }
    }
  }
  guess = best;
  return total < before;
}

} // namespace

std::optional<assignment> greedy(const search_space& space) {
  auto now = space.empty;
  assignment guess;
  double sum = 0;
  for (std::size_t i = 0; i < space.steps(); ++i) {
    const auto& list = space.candidates.of[i];
    auto least = infinity;
    std::size_t best = 0;
    for (std::size_t c = 0; c < list.size(); ++c) {
      auto total = tried(space, now, sum, i, list[c]);
      if (total < least) {
        least = total;
        best = c;
      }
    }
    if (least == infinity)
      return std::nullopt;
    const auto& way = space.way(i, list[best]);
    sum += space.cost(i, list[best], now.shares_of(way, list[best]));
    now.place(way, list[best]);
    guess.push_back(best);
  }
  return guess;
}

assignment improved(const search_space& space, assignment guess, watch& until) {
  auto scratch = space.empty;
  auto start = evaluate(space, guess, scratch);
  auto total = start.value_or(score{infinity, 0, 0}).total;
  while (move_one(space, guess, total, scratch, until)) {
  }
  return guess;
}

} // namespace roscell::allocation
