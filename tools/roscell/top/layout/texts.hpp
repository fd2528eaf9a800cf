#pragma once

#include "tools/roscell/top/layout/frame.hpp"

#include <string>
#include <vector>

namespace roscell::cli::top {

/// The title of the text that is open, and its lines.
struct open_text {
  std::string title;
  std::vector<std::string> lines;
};

/// What is shown instead of the lists: details, a log, events or help, of them
/// the lines in which the filter stands.
open_text text_of(const scene& shown, const frame_style& style);

} // namespace roscell::cli::top
