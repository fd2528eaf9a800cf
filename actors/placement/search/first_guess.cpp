#include "actors/placement/search/first_guess.hpp"

namespace roscell::allocation {

namespace {

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

/// The nodes of a guess, by how many steps are on them.
class crowd {
public:
  crowd(const search_space& space, const assignment& guess)
      : steps_(space.asked.nodes.size()) {
    for (std::size_t i = 0; i < guess.size(); ++i)
      ++steps_[space.choice(i, guess[i]).node];
  }

  /// An equal node that is idle as well comes before this one.
  bool repeats(const search_space& space, std::uint32_t node) const {
    auto twin = space.candidates.twins[node];
    return twin >= 0 && steps_[node] == 0
           && steps_[static_cast<std::size_t>(twin)] == 0;
  }

private:
  std::vector<std::size_t> steps_;
};

/// Moves one step to where the total is least. False when it stays.
bool move_step(const search_space& space, std::size_t step, assignment& guess,
               double& total, occupancy& scratch, watch& until) {
  const crowd now(space, guess);
  const auto before = guess[step];
  auto best = before;
  for (std::size_t c = 0; c < space.candidates.of[step].size(); ++c) {
    if (c == before || now.repeats(space, space.choice(step, c).node))
      continue;
    if (until.must_stop())
      break;
    guess[step] = c;
    auto value = evaluate(space, guess, scratch);
    if (value && value->total < total) {
      total = value->total;
      best = c;
    }
  }
  guess[step] = best;
  return best != before;
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
      if (space.has_idle_twin(list[c], now)
          || space.is_apart(i, list[c], guess))
        continue;
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
  // Done once every step in a row has stayed.
  std::size_t stayed = 0;
  for (std::size_t i = 0; stayed < guess.size() && !until.stopped(); ++i)
    stayed = move_step(space, i % guess.size(), guess, total, scratch, until)
                 ? 0
                 : stayed + 1;
  return guess;
}

} // namespace roscell::allocation
