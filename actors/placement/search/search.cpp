#include "actors/placement/search/search.hpp"

#include <algorithm>
#include <cmath>

namespace roscell::allocation {

search::search(const search_space& space, const lower_bound& bound,
               const assignment& start, watch& until)
    : space_(space), bound_(bound), until_(until), now_(space.empty),
      branches_(space.steps()), current_(space.steps()), best_(start) {
  auto value = evaluate(space, start, now_);
  best_total_ = value.value_or(score{infinity, 0, 0}).total;
  proven_ = best_total_;
}

void search::minimise() {
  settling_ = false;
  done_ = false;
  proven_ = infinity;
  visit(0, 0);
  proven_ = std::min(proven_, best_total_);
}

void search::settle_tie() {
  settling_ = true;
  done_ = false;
  visit(0, 0);
}

double search::total_at_least(double sum, double load) const {
  return sum / static_cast<double>(space_.steps()) + space_.asked.alpha * load;
}

/// While settling, the width covers what the bounds lose by rounding, so that
/// no tie is lost; the exact comparison is made at the end of a branch.
bool search::prunes(double bound) const {
  if (!settling_)
    return bound >= best_total_;
  auto scale = 1 + space_.asked.alpha + std::abs(space_.asked.gpu_bonus);
  return bound > best_total_ + tie_width * (1 + scale);
}

void search::visit(std::size_t depth, double sum) {
  if (depth == space_.steps()) {
    reach_end(sum);
    return;
  }
  list_branches(depth, sum);
  visit_branches(depth);
}

void search::list_branches(std::size_t depth, double sum) {
  auto& branches = branches_[depth];
  branches.clear();
  auto load = bound_.load(now_, depth);
  if (prunes(total_at_least(sum + bound_.balance(now_, depth, depth), load)))
    return;
  auto rest = bound_.balance(now_, depth, depth + 1);
  const auto& list = space_.candidates.of[depth];
  for (std::size_t c = 0; c < list.size(); ++c) {
    auto all = now_.shares_of(space_.way(depth, list[c]), list[c]);
    if (!all.fit() || space_.has_idle_twin(list[c], now_)
        || space_.is_apart(depth, list[c], current_))
      continue;
    auto with = sum + space_.cost(depth, list[c], all);
    auto bound = total_at_least(with + rest, load);
    if (!prunes(bound))
      branches.push_back({c, with, bound});
  }
  // The order of the list is that of the tie rule, and stays when settling.
  if (!settling_)
    std::stable_sort(branches.begin(), branches.end(),
                     [](const branch& left, const branch& right) {
                       return left.bound < right.bound;
                     });
}

void search::visit_branches(std::size_t depth) {
  // By position, since nothing below changes this depth's list.
  for (std::size_t b = 0; b < branches_[depth].size() && !done_; ++b) {
    auto next = branches_[depth][b];
    if (prunes(next.bound))
      continue;
    if (until_.must_stop()) {
      if (!settling_)
        proven_ = std::min(proven_, next.bound);
      continue;
    }
    const auto& choice = space_.choice(depth, next.position);
    current_[depth] = next.position;
    auto before = now_.place(space_.way(depth, choice), choice);
    visit(depth + 1, next.sum);
    now_.restore(choice, before);
  }
}

void search::reach_end(double sum) {
  auto total = score_of(space_, sum, now_).total;
  if (settling_) {
    done_ = total <= best_total_ + tie_width;
    if (done_)
      best_ = current_;
  } else if (total < best_total_) {
    best_total_ = total;
    best_ = current_;
  }
}

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
