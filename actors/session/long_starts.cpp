#include "actors/session/long_starts.hpp"

#include "actors/edge/session/limits.hpp"

#include <cstddef>
#include <utility>

namespace roscell {

namespace {

/// What of a spec has no narrow bound of its own.
size_t long_bytes(const instance_spec& spec) {
  auto result = spec.parameters.size();
  for (const auto& [name, value] : spec.environment)
    result += name.size() + value.size();
  for (const auto& argument : spec.arguments)
    result += argument.size();
  return result;
}

} // namespace

std::vector<instance_spec> take_long_starts(node_registered& answer) {
  std::vector<instance_spec> result;
  std::vector<instance_verdict> kept;
  size_t bytes = 0;
  for (auto& x : answer.verdicts) {
    if (!x.spec.empty())
      bytes += long_bytes(x.spec.front());
    if (x.spec.empty() || bytes <= limits::session::answered_starts_bytes)
      kept.push_back(std::move(x));
    else
      result.push_back(std::move(x.spec.front()));
  }
  answer.verdicts = std::move(kept);
  return result;
}

} // namespace roscell
