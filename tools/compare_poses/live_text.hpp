#pragma once

#include <cstddef>
#include <optional>
#include <string>

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

} // namespace roscell::comparison
