#pragma once

#include "tools/roscell/view/graph/drawing.hpp"

/// INTERNAL to drawings: one group of boxes that hang together.
namespace roscell::cli {

/// A box in its layer, or the place where an arrow passes a layer.
struct placed_box {
  size_t box = 0; ///< Which one; of a passage nothing.
  bool passage = false;
  size_t left = 0;
  size_t width = 1;

  size_t middle() const {
    return left + width / 2;
  }
};

/// A part of an arrow, from a place of one layer to one of the next.
struct arrow_part {
  size_t from = 0;   ///< Place in the upper layer.
  size_t to = 0;     ///< Place in the lower layer.
  bool ends = false; ///< It ends at a box there.
  std::vector<std::string> labels;
};

struct group_layout {
  std::vector<std::vector<placed_box>> layers;
  std::vector<std::vector<arrow_part>> bands; ///< Below each layer.
  size_t width = 0;
  bool fits = true;
};

/// @param members the boxes of the group, in ascending order.
group_layout laid_out(const std::vector<size_t>& members,
                      const std::vector<std::vector<std::string>>& boxes,
                      const std::vector<drawn_arrow>& arrows, size_t width);

} // namespace roscell::cli
