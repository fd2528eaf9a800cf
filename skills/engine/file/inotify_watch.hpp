#pragma once

#include "skills/engine/life/unique_fd.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell::engine {

/// Hears of changes in the file system, by inotify(7).
class inotify_watch {
public:
  struct event {
    int watch;
    std::uint32_t mask;
    std::string name; ///< of the file in a watched folder, else empty
  };

  /// Throws start_error when the user has no inotify instance left.
  inotify_watch();

  /// Watches a file or folder. Returns the number of the watch, or -1 with
  /// errno set.
  int add(const std::string& path, std::uint32_t mask);

  void remove(int watch);

  /// The events that have come in, which may be none.
  std::vector<event> read();

  /// Readable when there are events.
  int fd() const noexcept {
    return fd_.get();
  }

private:
  unique_fd fd_;
};

} // namespace roscell::engine
