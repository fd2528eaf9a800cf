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

/// Gives `file` the first free of the names file.aside-1, file.aside-2, and so
/// on, with all that is named like it and a dash (what SQLite keeps beside its
/// file). Returns the new path; an empty one if there is no such file.
/// Errors: internal.
edge_result<std::filesystem::path> put_aside(const std::filesystem::path& file);

} // namespace roscell
