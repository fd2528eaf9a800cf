#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <cstdint>
#include <filesystem>

/// /dev/shm, where fences of instances lie, and the messages of stock ROS 2
/// programs of one host.
namespace roscell::cli {

struct shared_memory_readings {
  bool exists = false;
  bool in_memory = false; ///< A tmpfs.
  bool all_write = false; ///< Mode 1777.
  int write_error = 0;    ///< Of making a file there; 0: this user may.
  uint64_t size = 0;
  uint64_t free = 0;
};

shared_memory_readings read_shared_memory(const std::filesystem::path& folder);

finding judge_shared_memory(const std::filesystem::path& folder,
                            const shared_memory_readings& memory);

/// The folders of fences, roscell-UID, that are not that user's own: one that
/// somebody else has made is in the way of whatever may move to another node.
findings judge_fence_folders(const std::filesystem::path& folder);

findings check_shared_memory(const checked_host& host);

} // namespace roscell::cli
