#include "actors/core/skill_changes.hpp"

#include <set>
#include <string>

namespace roscell {

namespace {

/// Those of `skills` that are not among `others`.
std::vector<installed_skill>
without_others(const std::vector<installed_skill>& skills,
               const std::vector<installed_skill>& others) {
  std::set<std::string> known;
  for (const auto& x : others)
    known.insert(x.hash);
  std::vector<installed_skill> result;
  for (const auto& x : skills)
    if (known.count(x.hash) == 0)
      result.push_back(x);
  return result;
}

} // namespace

skill_changes changes_between(const std::vector<installed_skill>& before,
                              const std::vector<installed_skill>& after) {
  return {without_others(after, before), without_others(before, after)};
}

} // namespace roscell
