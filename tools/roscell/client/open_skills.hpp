#pragma once

#include "roscell/node_config.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// A folder of skills that others may change.
struct open_skills {
  std::string what;   ///< The folder, and who may.
  std::string remedy; ///< A command.
};

/// Those that a node which runs as root starts. None for a node of another
/// user: there it is his own affair.
std::vector<open_skills> find_open_skills(const node_config& config);

} // namespace roscell::cli
