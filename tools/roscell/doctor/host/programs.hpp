#pragma once

#include "actors/edge/engine/engine_search.hpp"
#include "messages/skill.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// What programs of this host can do, and what they are.
namespace roscell::cli {

/// @param built version of Fast DDS that this program was built with.
/// @param loaded path of the library that it runs with.
finding judge_versions(const std::string& built, const std::string& loaded);

/// A problem each, or how many skills can be loaded.
findings judge_skills(size_t good, const std::vector<skill_problem>& problems);

findings check_versions(const checked_host& host);
findings check_skills(const checked_host& host);

/// What asking at one socket came to.
struct asked_engine {
  std::string socket;
  bool exists = false;
  edge_result<found_engine> answer;
};

/// Asks at every socket that `runtime` of a node may mean; none for "process".
std::vector<asked_engine> ask_engines(const std::string& runtime);

/// @param unified_cgroups the host has cgroups of version 2.
findings judge_engines(const std::string& runtime,
                       const std::vector<asked_engine>& engines,
                       bool unified_cgroups);

findings check_engines(const checked_host& host);

} // namespace roscell::cli
