#pragma once

#include "messages/skill.hpp"
#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What programs of this host can do, and what they are.
namespace roscell::cli {

/// @param most that a process may have open; a node raises its own to that.
finding judge_descriptors(uint64_t most);

/// @param built version of Fast DDS that this program was built with.
/// @param loaded path of the library that it runs with.
finding judge_versions(const std::string& built, const std::string& loaded);

/// A problem each, or how many skills can be loaded.
findings judge_skills(size_t good, const std::vector<skill_problem>& problems);

findings check_descriptors(const checked_host& host);
findings check_versions(const checked_host& host);
findings check_skills(const checked_host& host);

} // namespace roscell::cli
