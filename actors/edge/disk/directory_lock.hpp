#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <filesystem>

namespace roscell {

/// Holds a folder for one process, for as long as it lives: the kernel drops
/// the lock with the descriptor, so a killed holder leaves none behind.
class directory_lock {
public:
  /// Makes the folder (mode 0700) if it is not there, and takes `folder/lock`.
  /// Errors: conflict (held by another node, named by its process id),
  /// unauthorized (others than this user and root may put something into it),
  /// internal (no permission, no room, not a folder).
  static edge_result<directory_lock> take(const std::filesystem::path& folder);

private:
  explicit directory_lock(unique_fd fd);

  unique_fd fd_;
};

} // namespace roscell
