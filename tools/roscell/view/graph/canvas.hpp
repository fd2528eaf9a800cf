#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// INTERNAL to drawings: a sheet on which lines and text are put. Lines that
/// meet are joined, and text stands above lines.
namespace roscell::cli {

class canvas {
public:
  /// A line from one place to another in the same column or row.
  void line(size_t x1, size_t y1, size_t x2, size_t y2);

  /// A frame with these corners.
  void frame(size_t left, size_t top, size_t right, size_t bottom);

  void text(size_t x, size_t y, std::string_view words);

  /// Each line ended, without blanks at its end.
  std::string str() const;

private:
  enum side : uint8_t { up = 1, down = 2, left = 4, right = 8 };

  struct cell {
    uint8_t sides = 0;
    std::string letter; ///< Empty: none.
  };

  cell& at(size_t x, size_t y);

  std::vector<std::vector<cell>> rows_;
};

} // namespace roscell::cli
