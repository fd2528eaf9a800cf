#pragma once

#include "messages/skill.hpp"

#include <vector>

namespace roscell {

/// What has become of a node's builds. One whose folder was edited is removed,
/// and there is another one.
struct skill_changes {
  std::vector<installed_skill> added;
  std::vector<installed_skill> removed;
};

/// By their hashes.
skill_changes changes_between(const std::vector<installed_skill>& before,
                              const std::vector<installed_skill>& after);

} // namespace roscell
