#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace roscell::comparison {

/// Waits for files to grow or appear.
class file_watch {
public:
  using clock = std::chrono::steady_clock;

  /// The folders of the files must be there. Throws std::runtime_error.
  explicit file_watch(const std::vector<std::string>& paths);

  ~file_watch();

  file_watch(const file_watch&) = delete;
  file_watch& operator=(const file_watch&) = delete;

  /// Waits until something has changed in the folders since the last call, but
  /// not past `deadline`. Returns whether something has.
  bool wait_until(clock::time_point deadline) const;

private:
  const int fd_;
};

} // namespace roscell::comparison
