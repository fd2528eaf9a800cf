#pragma once

#include "messages/skill.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// A task request in YAML that does these operations one after the other, with
/// comments on what to fill in. It is valid as it is: `roscell check` takes it.
/// A step reads what the one before it writes, where its skill takes that.
/// `skills` has every one of the operations.
std::string task_skeleton(const std::string& task,
                          const std::vector<std::string>& operations,
                          const skill_list& skills);

} // namespace roscell::cli
