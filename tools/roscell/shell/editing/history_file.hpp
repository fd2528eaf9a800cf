#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roscell::cli {

/// The lines that a user has typed, one per line, the oldest first; only the
/// user can read them. What cannot be written is not kept: nobody is stopped
/// by that.
class history_file {
public:
  static constexpr size_t most_lines = 1000;

  explicit history_file(std::filesystem::path file);

  /// What was kept before, and since.
  const std::vector<std::string>& lines() const {
    return lines_;
  }

  /// Keeps a line, unless it begins with a blank, is empty, or is that before
  /// it. Returns whether it was kept.
  bool add(const std::string& line);

private:
  void shorten() const;

  std::filesystem::path file_;
  std::vector<std::string> lines_;
};

/// $XDG_STATE_HOME/roscell/history, else that below ~/.local/state. Empty if
/// neither is known.
std::filesystem::path default_history();

} // namespace roscell::cli
