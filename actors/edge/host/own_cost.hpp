#pragma once

#include <filesystem>

namespace roscell {

/// What this process has cost its host since it was started. What cannot be
/// read is 0.
struct own_cost {
  double cpu_seconds = 0;
  double resident_bytes = 0;
  double pss_bytes = 0;     ///< The same, shared pages divided among users.
  double written_bytes = 0; ///< To disks.
  double open_files = 0;
  double started_s = 0; ///< When it was, after the host's boot.
};

/// @param process the process's folder in /proc; tests have their own.
own_cost read_own_cost(const std::filesystem::path& process = "/proc/self");

/// When the host was booted, in whole seconds since 1970; 0 if that is not
/// known. It stays the same unless somebody sets the host's clock.
double read_boot_time(const std::filesystem::path& file = "/proc/stat");

} // namespace roscell
