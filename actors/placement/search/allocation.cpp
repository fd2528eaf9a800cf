#include "actors/placement/search/allocation.hpp"

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/bounds/lower_bound.hpp"
#include "actors/placement/search/group_search.hpp"
#include "actors/placement/search/groups.hpp"
#include "actors/placement/search/report/explain.hpp"
#include "actors/placement/search/report/validate.hpp"
#include "actors/placement/search/search.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace roscell::allocation {

namespace {

/// Bounds the memory and the time that groups take: some 50 ms.
constexpr std::size_t most_groups = 400'000;

/// About 50 ns of work each, so that the lists of the bound take a tenth of the
/// budget at most, and never more than 0.2 s.
std::size_t row_work(const watch& until) {
  constexpr std::size_t most = 4'000'000;
  constexpr std::size_t per_ms = 2'000;
  const auto budget = static_cast<std::size_t>(until.budget().count());
  return budget == 0 ? most : std::min(most, budget * per_ms);
}

void refuse(const search_space& space, std::vector<std::size_t> conflict,
            result& answer) {
  answer.what = outcome::infeasible;
  answer.lower_bound = infinity;
  answer.message = conflict_text(space.asked, space.candidates, conflict);
  auto others = explain_conflict(space, conflict);
  std::move(others.begin(), others.end(), std::back_inserter(answer.rejected));
  answer.conflict = std::move(conflict);
}

/// Why a step has no candidate: alone, or as it must share a node with others.
std::vector<std::size_t> lonely_steps(const search_space& space,
                                      std::size_t step, const result& answer) {
  const bool fits_alone = std::any_of(
      answer.rejected.begin(), answer.rejected.end(), [&](const auto& x) {
        return x.step == step
               && x.reasons.front().kind == reason_kind::combination;
      });
  if (!fits_alone)
    return {step};
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < space.steps(); ++i)
    if (space.asked.steps[i].together == space.asked.steps[step].together)
      result.push_back(i);
  return result;
}

/// The steps that have no candidate at all are each a conflict of their own;
/// the first of them is named.
bool refuse_lonely_step(const search_space& space, result& answer) {
  for (std::size_t i = 0; i < space.steps(); ++i)
    if (space.candidates.of[i].empty()) {
      refuse(space, lonely_steps(space, i, answer), answer);
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

/// Runs one of the two searches, and tells what it has found.
template <class Search>
void conclude(const search_space& space, Search run, const watch& until,
              result& answer) {
  run.minimise();
  if (!until.stopped())
    run.settle_tie();
  auto scratch = space.empty;
  answer.value = evaluate(space, run.best(), scratch).value_or(score{});
  answer.placements = placements(space, run.best());
  answer.lower_bound = until.stopped() ? run.proven() : answer.value.total;
}

/// False where there are too many steps or groups for it.
bool optimise_groups(const search_space& space, const assignment& start,
                     watch& until, result& answer) {
  if (space.steps() > most_grouped_steps)
    return false;
  lower_bound bound(space.asked, space.candidates, space.empty, 1);
  std::vector<double> least_cost;
  for (std::size_t i = 0; i < space.steps(); ++i)
    least_cost.push_back(bound.least_cost(i));
  auto scratch = space.empty;
  auto total = evaluate(space, start, scratch).value_or(score{}).total;
  // Ties must be among the groups, whatever rounding does to the sums.
  auto groups =
      find_groups(space, least_cost, total + 1e-9, most_groups, until);
  if (!groups)
    return false;
  auto least = std::accumulate(least_cost.begin(), least_cost.end(), 0.0)
               / static_cast<double>(space.steps());
  conclude(space, group_search(space, *groups, start, least, until), until,
           answer);
  return true;
}

void optimise(const search_space& space, const assignment& start, watch& until,
              result& answer) {
  if (!optimise_groups(space, start, until, answer)) {
    lower_bound bound(space.asked, space.candidates, space.empty,
                      until.stopped() ? 1 : row_work(until));
    conclude(space, search(space, bound, start, until), until, answer);
  }
  answer.what = until.stopped() ? outcome::best_found : outcome::optimal;
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

namespace {

bool is_strict(const exclusion& x) {
  return !x.cpu_floor;
}

/// Whether a floored reading may find more than the strict one. A node that has
/// refused in the strict one was busy then, whatever it says now.
bool is_compressible(const problem& asked) {
  return std::any_of(asked.nodes.begin(), asked.nodes.end(),
                     [](const auto& x) { return x.cpu_compressible > 0; })
         || std::any_of(asked.excluded.begin(), asked.excluded.end(),
                        is_strict);
}

} // namespace

problem read_with_floor(problem asked) {
  for (auto& host : asked.nodes)
    host.cpu.used =
        std::max(0.0, host.cpu.used - std::exchange(host.cpu_compressible, 0));
  auto& xs = asked.excluded;
  xs.erase(std::remove_if(xs.begin(), xs.end(), is_strict), xs.end());
  return asked;
}

floored_result allocate_with_floor(problem asked, const limits& bounds) {
  auto found = allocate(asked, bounds);
  if (found.what != outcome::infeasible || !is_compressible(asked))
    return {std::move(asked), std::move(found), false};
  auto relaxed = read_with_floor(std::move(asked));
  auto second = allocate(relaxed, bounds);
  return {std::move(relaxed), std::move(second), true};
}

} // namespace roscell::allocation
