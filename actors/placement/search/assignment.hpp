#pragma once

#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/problem.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace roscell::allocation {

/// Per step, the position of its choice among the step's candidates. Compared
/// lexicographically, this is the order of the tie rule.
using assignment = std::vector<std::size_t>;

/// The problem, its candidates and the empty occupancy: what every part of
/// the search reads.
struct search_space {
  const problem& asked;
  const candidate_set& candidates;
  const occupancy& empty;

  std::size_t steps() const {
    return asked.steps.size();
  }
  const candidate& choice(std::size_t step, std::size_t position) const {
    return candidates.of[step][position];
  }
  const deployment& way(std::size_t step, const candidate& choice) const {
    return asked.steps[step].deployments[choice.deployment];
  }
  /// Whether an idle equal node comes before this one. Taking that instead
  /// gives the same total to the last bit, and an earlier assignment.
  bool has_idle_twin(const candidate& choice, const occupancy& now) const {
    auto twin = candidates.twins[choice.node];
    return twin >= 0 && !now.hosts(static_cast<std::size_t>(twin));
  }
  /// Whether a step at this candidate would be on another node than one before
  /// it that it must share a node with.
  bool is_apart(std::size_t step, const candidate& at,
                const assignment& earlier) const {
    const auto group = asked.steps[step].together;
    if (group == 0)
      return false;
    for (std::size_t i = 0; i < step; ++i)
      if (asked.steps[i].together == group)
        return choice(i, earlier[i]).node != at.node;
    return false;
  }
  /// Variance and bonus of a step at a candidate, given what precedes it.
  double cost(std::size_t step, const candidate& choice,
              const shares& all) const {
    return all.variance() + (way(step, choice).needs_gpu ? asked.gpu_bonus : 0);
  }
};

/// The score where costs sum up to `sum` and `now` holds every step.
score score_of(const search_space& space, double sum, const occupancy& now);

/// The score of an assignment, or nothing when it does not fit. `scratch` is
/// an empty occupancy to work in, and empty again afterwards.
std::optional<score> evaluate(const search_space& space,
                              const assignment& chosen, occupancy& scratch);

/// An assignment that fits, as the answer tells it.
std::vector<placement> placements(const search_space& space,
                                  const assignment& chosen);

/// Counts the branches of a search and says when it must end.
class watch {
public:
  /// The budget runs from here. Keeps a reference to `given`.
  explicit watch(const limits& given) : given_(given) {
    if (given.budget.count() > 0)
      end_ = given.now() + given.budget;
  }

  /// Called before each branch. Once true, it stays true.
  bool must_stop() {
    ++branches_;
    stopped_ = stopped_ || (given_.cancelled && given_.cancelled())
               || (given_.budget.count() > 0 && given_.now() >= end_);
    return stopped_;
  }

  /// 0 means no limit.
  std::chrono::milliseconds budget() const {
    return given_.budget;
  }
  bool stopped() const {
    return stopped_;
  }
  std::size_t branches() const {
    return branches_;
  }

private:
  const limits& given_;
  std::chrono::steady_clock::time_point end_;
  std::size_t branches_ = 0;
  bool stopped_ = false;
};

} // namespace roscell::allocation
