#pragma once

#include "client/cell_model.hpp"
#include "tools/roscell/top/layout/controls.hpp"

#include <array>
#include <string>
#include <vector>

namespace roscell::cli::top {

/// What a screen can show, and when.
struct frame_style {
  size_t width = 80;
  size_t height = 24;
  bool utf8 = true;
  int64_t now_unix_ms = 0;
};

/// Everything that is shown, from which each frame is made anew.
struct scene {
  const cell_model& known;
  const std::vector<std::string>& log; ///< Lines of the log that is open.
  const controls& now;
};

/// The lines of the whole screen, and what keys need to know of them.
struct frame {
  std::vector<line> lines;
  tables lists;
  size_t page = 1;       ///< Lines of the list, or text, that keys move in.
  size_t text_lines = 0; ///< Of the text that is open.
};

frame make_frame(const scene& shown, const frame_style& style);

/// How many lines each list gets: three at least, as long as there are, then
/// those that keys mean, then the others.
std::array<size_t, listed_kinds.size()>
list_heights(const std::array<size_t, listed_kinds.size()>& wanted,
             size_t focus, size_t room);

/// The title of the text that is open, and its lines.
struct open_text {
  std::string title;
  std::vector<std::string> lines;
};

/// What is shown instead of the lists: details, a log, events or help, of them
/// the lines in which the filter stands.
open_text text_of(const scene& shown, const frame_style& style);

} // namespace roscell::cli::top
