#include "actors/placement/search/report/alternative.hpp"

#include "actors/placement/search/allocation.hpp"

namespace roscell::allocation {

result alternative(problem asked, const result& chosen, std::size_t step,
                   const limits& bounds) {
  const auto& taken = chosen.placements[step];
  asked.excluded.push_back(
      {step, taken.node, taken.deployment, taken.gpu, "is the one chosen"});
  return allocate(asked, bounds);
}

} // namespace roscell::allocation
