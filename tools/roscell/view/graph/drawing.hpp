#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::cli {

/// An arrow from one box to another one, with what goes along it.
struct drawn_arrow {
  size_t from = 0;
  size_t to = 0;
  std::vector<std::string> labels;
};

/// Boxes with their lines of text, and arrows from top to bottom between them,
/// no line longer than `width`. Boxes that hang together are drawn together,
/// those groups beside each other where there is room. Arrows that lead back
/// are left out, labels where several arrows share the space between two
/// layers. Empty if so many boxes cannot stand beside each other.
std::string drawing(const std::vector<std::vector<std::string>>& boxes,
                    const std::vector<drawn_arrow>& arrows, size_t width);

} // namespace roscell::cli
