#include "actors/placement/search/running/better_moves.hpp"

#include "actors/placement/search/allocation.hpp"
#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/report/validate.hpp"
#include "actors/placement/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace roscell::allocation {

namespace {

seat seat_of(const problem& asked, const candidate& at) {
  const int gpu = at.gpu < 0 ? -1 : asked.nodes[at.node].gpus[at.gpu].index;
  return {at.node, at.deployment, gpu};
}

bool is_at(const problem& asked, const candidate& at, const seat& wanted) {
  const auto there = seat_of(asked, at);
  return there.node == wanted.node && there.deployment == wanted.deployment
         && there.gpu == wanted.gpu;
}

/// Positions of the steps' seats among their candidates; past the end for one
/// that is at none.
assignment positions(const problem& asked, const candidate_set& candidates,
                     const std::vector<seat>& now) {
  assignment result;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto& list = candidates.of[i];
    const auto found =
        std::find_if(list.begin(), list.end(),
                     [&](const auto& x) { return is_at(asked, x, now[i]); });
    result.push_back(static_cast<std::size_t>(found - list.begin()));
  }
  return result;
}

/// Steepest descent, one step at a time.
class descent {
public:
  descent(const search_space& space, assignment start, double total,
          watch& until)
      : space_(space), now_(std::move(start)), total_(total), until_(until),
        scratch_(space.empty), moved_(now_.size(), false) {}

  std::vector<step_move> run(const move_request& request) {
    std::vector<step_move> result;
    const auto least = request.min_gain * std::abs(total_);
    while (result.size() < request.most) {
      const auto best = best_move();
      if (!best || best->gain < least)
        break;
      now_[best->step] = best->position;
      moved_[best->step] = true;
      total_ -= best->gain;
      result.push_back(
          {best->step,
           seat_of(space_.asked, space_.choice(best->step, best->position)),
           best->gain});
    }
    return result;
  }

  score value() {
    return evaluate(space_, now_, scratch_).value_or(score{});
  }

private:
  struct choice {
    std::size_t step;
    std::size_t position;
    double gain;
  };

  std::optional<choice> best_move() {
    std::optional<choice> best;
    for (std::size_t i = 0; i < now_.size(); ++i)
      if (!moved_[i] && space_.asked.steps[i].together == 0)
        try_step(i, best);
    return best;
  }

  void try_step(std::size_t step, std::optional<choice>& best) {
    const auto before = now_[step];
    const auto node = space_.choice(step, before).node;
    for (std::size_t c = 0; c < space_.candidates.of[step].size(); ++c) {
      if (space_.choice(step, c).node == node)
        continue;
      if (until_.must_stop())
        break;
      now_[step] = c;
      const auto value = evaluate(space_, now_, scratch_);
      if (value && total_ - value->total > (best ? best->gain : tie_width))
        best = choice{step, c, total_ - value->total};
    }
    now_[step] = before;
  }

  const search_space& space_;
  assignment now_;
  double total_;
  watch& until_;
  occupancy scratch_;
  std::vector<bool> moved_;
};

/// How low any total can be.
void bound_below(const problem& asked, const limits& bounds, move_list& to) {
  to.lower_bound = std::min(0.0, asked.gpu_bonus);
  if (asked.steps.size() <= max_steps)
    to.lower_bound =
        std::max(to.lower_bound, allocate(asked, bounds).lower_bound);
  to.lower_bound = std::min(to.lower_bound, to.after.total);
  to.optimal = to.after.total - to.lower_bound <= tie_width;
}

} // namespace

std::vector<std::size_t> misplaced(const problem& asked,
                                   const std::vector<seat>& now) {
  std::vector<rejected_candidate> rejected;
  const auto candidates = find_candidates(asked, rejected);
  const auto where = positions(asked, candidates, now);
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < where.size(); ++i)
    if (where[i] == candidates.of[i].size())
      result.push_back(i);
  return result;
}

move_list better_moves(const problem& asked, const std::vector<seat>& now,
                       const move_request& request, const limits& bounds) {
  move_list result;
  watch until(bounds);
  occupancy empty(asked);
  std::vector<rejected_candidate> rejected;
  const auto candidates = find_candidates(asked, rejected);
  const search_space space{asked, candidates, empty};
  const auto start = positions(asked, candidates, now);
  auto scratch = empty;
  const auto value = evaluate(space, start, scratch);
  if (!value) {
    result.message = "the running steps do not fit as they are";
    return result;
  }
  descent search(space, start, value->total, until);
  result.before = *value;
  result.moves = search.run(request);
  result.after = search.value();
  bound_below(asked, bounds, result);
  return result;
}

} // namespace roscell::allocation
