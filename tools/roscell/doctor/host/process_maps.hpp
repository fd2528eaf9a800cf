#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace roscell::cli {

/// A file that a process has in its memory.
struct mapped_file {
  std::filesystem::path process; ///< "/proc/12".
  std::string device; ///< "00:1b", of the file system; each mount has its own.
  std::string name;   ///< Below the folder that was asked for.
};

/// Visits the files below `folder`, as its process sees it, that each process
/// has mapped.
/// @returns how many processes this user may not look at.
size_t visit_mapped_files(const std::filesystem::path& proc,
                          const std::filesystem::path& folder,
                          const std::function<void(const mapped_file&)>& visit);

/// What begins so in /dev/shm is Fast DDS's: "fastrtps_port7411".
bool is_dds_file(const std::string& name);

} // namespace roscell::cli
