#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Files by which programs of Fast DDS on one host share memory. Fast DDS holds
/// a lock on a file beside each (`NAME_el`, `NAME_sl`) for as long as it uses
/// the memory, and the kernel drops that with the process.
namespace roscell::cli {

/// Files that belong together: "fastrtps_port7411", its locks, and
/// "sem.fastrtps_port7411_mutex".
struct dds_memory {
  std::vector<std::filesystem::path> files; ///< Sorted.
  uint64_t bytes = 0;                       ///< That they take.
  uid_t owner = 0;                          ///< Of the first of them.
  bool open_to_all = true; ///< Every user may write to each of them.
  bool used = true;        ///< A lock is held, or nobody knows.
};

/// Those of a folder, by name. What this user may not open counts as used, and
/// what has no lock.
std::vector<dds_memory> find_dds_memory(const std::filesystem::path& folder);

/// Memory whose programs are gone, and programs of several users that cannot
/// write to each other's memory.
findings judge_dds_memory(const std::vector<dds_memory>& all);

findings check_leftovers(const checked_host& host);

} // namespace roscell::cli
