#pragma once

#include <cstddef>
#include <functional>

namespace roscell {

/// A question to several nodes, until all have answered. Whoever asks counts as
/// one of them until he has asked all.
struct open_questions {
  size_t open = 1;
  std::function<void()> on_all; ///< It must not hold this itself.

  void finish_one() {
    if (--open == 0)
      on_all();
  }
};

} // namespace roscell
