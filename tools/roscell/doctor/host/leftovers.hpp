#pragma once

#include "tools/roscell/doctor/finding.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace roscell::cli {

/// Files that nobody uses any more.
struct leftovers {
  std::vector<std::filesystem::path> files;
  uint64_t bytes = 0; ///< That they take.
};

/// Files of Fast DDS whose owners are gone. Fast DDS holds a lock on a file
/// beside each (`NAME_el`, `NAME_sl`) for as long as it uses the memory, and
/// the kernel drops that with the process. Where a file has none, nobody may
/// have it mapped; where this user cannot know, it is left out.
leftovers find_dds_leftovers(const std::filesystem::path& folder,
                             const std::filesystem::path& proc);

/// Fences (actors/edge/process/fence_file.hpp) whose moment has passed: nothing
/// runs behind them.
leftovers find_fence_leftovers(const std::filesystem::path& folder,
                               int64_t now_boot_ms);

/// @param whose "Fast DDS".
finding judge_leftovers(const leftovers& left, const std::string& whose,
                        const std::string& why);

} // namespace roscell::cli
