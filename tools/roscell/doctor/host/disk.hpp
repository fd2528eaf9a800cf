#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Where a node keeps its files.
namespace roscell::cli {

struct disk_readings {
  std::filesystem::path data_dir;
  std::filesystem::path existing; ///< It, or the folder that it would be in.
  int write_error = 0;            ///< 0: this user may write there.
  uint64_t free_bytes = 0;        ///< For this user.
  uint64_t free_files = 0;        ///< Inodes.
  bool counts_files = false;      ///< Not all file systems have a number.
};

disk_readings read_disk(const std::filesystem::path& data_dir);

findings judge_disk(const disk_readings& disk);

/// How long it took to keep 4 KiB, each time, in ms. Takes a second at most,
/// and leaves no file. Nothing: it cannot be written there.
std::optional<std::vector<double>>
measure_fsync(const std::filesystem::path& folder);

/// @param folder where it was measured.
finding judge_fsync(const std::filesystem::path& folder,
                    std::vector<double> took_ms);

findings check_disk(const checked_host& host);
findings check_fsync(const checked_host& host);

} // namespace roscell::cli
