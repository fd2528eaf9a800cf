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

} // namespace roscell::allocation
