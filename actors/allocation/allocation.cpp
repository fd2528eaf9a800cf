#include "actors/allocation/allocation.hpp"

#include "actors/allocation/assignment.hpp"
#include "actors/allocation/explain.hpp"
#include "actors/allocation/feasibility.hpp"
#include "actors/allocation/first_guess.hpp"
#include "actors/allocation/lower_bound.hpp"
#include "actors/allocation/search.hpp"
#include "actors/allocation/validate.hpp"
#include "actors/allocation/watch.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

namespace roscell::allocation {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void refuse(const search_space& space, std::vector<std::size_t> conflict,
            result& answer) {
  answer.what = outcome::infeasible;
  answer.lower_bound = infinity;
  answer.message = conflict_text(space.asked, space.candidates, conflict);
  auto others = explain_conflict(space, conflict);
  std::move(others.begin(), others.end(), std::back_inserter(answer.rejected));
  answer.conflict = std::move(conflict);
}

/// The steps that have no candidate at all are each a conflict of their own;
/// the first of them is named.
bool refuse_lonely_step(const search_space& space, result& answer) {
  for (std::size_t i = 0; i < space.steps(); ++i)
    if (space.candidates.of[i].empty()) {
      refuse(space, {i}, answer);
      return true;
    }
  return false;
}

/// An assignment that fits, unless there is none or the watch stops it.
std::optional<assignment> first_assignment(const search_space& space,
                                           watch& until, result& answer) {
  if (auto guess = greedy(space))
    return improved(space, std::move(*guess), until);
  std::vector<std::size_t> all(space.steps());
  std::iota(all.begin(), all.end(), 0);
  auto fit =
      find_fit(space, all, std::numeric_limits<std::size_t>::max(), until);
  if (fit.what == verdict::fits)
    return improved(space, std::move(fit.found), until);
  if (fit.what == verdict::impossible)
    refuse(space, smallest_conflict(space, std::move(all), until), answer);
  return std::nullopt;
}

void optimise(const search_space& space, const assignment& start, watch& until,
              result& answer) {
  lower_bound bound(space.asked, space.candidates, space.empty);
  search run(space, bound, start, until);
  run.minimise();
  if (!until.stopped())
    run.settle_tie();
  auto scratch = space.empty;
  answer.value = evaluate(space, run.best(), scratch).value_or(score{});
  answer.placements = placements(space, run.best());
  answer.what = until.stopped() ? outcome::best_found : outcome::optimal;
  answer.lower_bound = until.stopped() ? run.proven() : answer.value.total;
  if (until.stopped())
    answer.message = "the search was stopped before it was proven that no "
                     "allocation is better";
}

void answer_undecided(const search_space& space, result& answer) {
  lower_bound bound(space.asked, space.candidates, space.empty);
  answer.what = outcome::undecided;
  answer.lower_bound =
      bound.balance(space.empty, 0, 0) / static_cast<double>(space.steps());
  answer.message = "the search was stopped before any allocation was found";
}

} // namespace

result allocate(const problem& asked, const limits& bounds) {
  result answer;
  if (auto bad = validate(asked)) {
    answer.message = *bad;
    return answer;
  }
  answer.warnings = warnings_about(asked);
  watch until(bounds);
  occupancy empty(asked);
  auto candidates = find_candidates(asked, answer.rejected);
  search_space space{asked, candidates, empty};
  if (refuse_lonely_step(space, answer))
    return answer;
  if (auto start = first_assignment(space, until, answer))
    optimise(space, *start, until, answer);
  else if (answer.what != outcome::infeasible)
    answer_undecided(space, answer);
  answer.expanded = until.branches();
  return answer;
}

} // namespace roscell::allocation
