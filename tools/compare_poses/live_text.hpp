#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roscell::comparison {

/// Of a terminal, in characters.
struct screen_size {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

/// Of the terminal that standard output is; nothing if it is none.
std::optional<screen_size> stdout_screen();

/// `text`, whose lines end with line ends, cut to what a screen can show with
/// the cursor below it. What is left out at the end is counted in a last line.
std::string fitted(const std::string& text, const screen_size& screen);

/// Text on a terminal that is written again and again in the same place.
class live_text {
public:
  /// What has to be written so that `text`, fitted, is in the place of the
  /// former one. What stood above it stays.
  std::string repainted(const std::string& text, const screen_size& screen);

private:
  std::size_t lines_ = 0;
};

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
