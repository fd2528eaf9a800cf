#pragma once

#include "tools/roscell/top/layout/line.hpp"

#include <vector>

namespace roscell::cli::top {

/// Of a resource of a node, in its own unit.
struct share {
  double others = 0;   ///< Used by programs that are none of ours.
  double reserved = 0; ///< By instances.
  double capacity = 0; ///< 0: not known.

  double used() const {
    return others + reserved;
  }

  /// Part of the capacity that is used, 0 where none is known.
  double part() const {
    return capacity > 0 ? used() / capacity : 0;
  }
};

/// A bar of that width: what others use, what is reserved, and what is free,
/// each with a character of its own. What is there at all is seen, as far as
/// there is room. Without UTF-8 it is "##++....".
std::vector<span> bar(const share& of, size_t width, bool utf8);

} // namespace roscell::cli::top
