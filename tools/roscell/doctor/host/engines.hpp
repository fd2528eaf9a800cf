#pragma once

#include "actors/edge/engine/engine_search.hpp"
#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

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
