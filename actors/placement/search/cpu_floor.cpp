#include "actors/placement/search/cpu_floor.hpp"

#include "actors/placement/search/allocation.hpp"

#include <algorithm>
#include <utility>

namespace roscell::allocation {

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
