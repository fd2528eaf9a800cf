#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// INTERNAL to this folder: the files of a folder, read with bounds.
namespace roscell {

/// How much of a folder is read before it is refused.
struct folder_limits {
  size_t max_files = 10'000;
  uint64_t max_bytes = 16ULL << 30; ///< Checkpoints of models are large.
  int max_depth = 32;
};

/// Thrown by these functions, and caught in this folder.
struct folder_failure {
  edge_error why;
};

/// The files and links below the folder, relative to it, in the order of their
/// bytes. Links to folders are not followed.
std::vector<std::filesystem::path>
list_files(const std::filesystem::path& folder, const folder_limits& limits);

bool is_link(const std::filesystem::path& path);

/// What a link points to, which must lie inside the folder.
std::string link_target(const std::filesystem::path& folder,
                        const std::filesystem::path& name);

/// A file that is open.
struct opened_file {
  unique_fd fd;
  bool program = false; ///< Its owner may execute it.
};

opened_file open_plain_file(const std::filesystem::path& path);

/// Reads a file to its end, which may move meanwhile, and takes its bytes from
/// those that are left.
void read_all(const opened_file& file, const std::filesystem::path& path,
              uint64_t& bytes_left,
              const std::function<void(std::string_view)>& on_bytes);

[[noreturn]] void throw_unreadable(const std::filesystem::path& path,
                                   const std::string& why);

} // namespace roscell
