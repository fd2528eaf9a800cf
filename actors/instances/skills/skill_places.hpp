#pragma once

#include "actors/edge/disk/folder_watch.hpp"

#include <filesystem>
#include <vector>

namespace roscell {

/// Where a node looks for skills.
struct skill_places {
  std::vector<std::filesystem::path> named; ///< They have to be there.
  std::vector<std::filesystem::path> usual; ///< They need not be.

  /// The directories that are to be read now.
  std::vector<std::filesystem::path> present() const;

  /// All in which something may change what is read: the directories, and in
  /// them the folders of skills with all that is in them. Of a folder that is
  /// no skill only the coming of a descriptor counts.
  std::vector<watched_folder> to_watch() const;
};

} // namespace roscell
