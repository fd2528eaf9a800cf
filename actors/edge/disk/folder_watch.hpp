#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/limits.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// A folder that is to be watched.
struct watched_folder {
  std::filesystem::path path;
  bool whole = false; ///< With all folders below it, links not followed.

  friend bool operator==(const watched_folder& x, const watched_folder& y) {
    return x.path == y.path && x.whole == y.whole;
  }

  friend bool operator!=(const watched_folder& x, const watched_folder& y) {
    return !(x == y);
  }
};

/// Tells that something changes in folders: files that are written, made,
/// renamed, removed, or get other rights. Nothing is read while nothing does.
class folder_watch {
public:
  /// Calls `on_change` on the io thread, `limits::folder::change_pause` apart
  /// at least. It may come once more after this object has ended.
  folder_watch(const std::shared_ptr<io_core>& core,
               std::function<void()> on_change,
               size_t most = limits::folder::watched);

  /// Watches these and no others from now on: what changes after the call is
  /// told. Of one that is not there the nearest folder above it is watched, so
  /// that its coming is told. The first ones count most, where there are more
  /// than can be watched. To be called by one thread. Blocks on the disk.
  ///
  /// Empty; or why not all are watched.
  std::string follow(const std::vector<watched_folder>& folders);

private:
  struct pass;

  shared_fd inotify_;
  size_t most_;
  std::set<int> watched_; ///< The kernel's numbers of them.
  fd_watch reading_;
};

} // namespace roscell
