#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

/// A regular expression as our schemas use them: `^`, then characters, escapes
/// and classes, each with an optional `*`, `+` or `{m,n}`, then `$`. Matching
/// neither recurses nor backtracks; std::regex does both, so that a long string
/// from outside can drive it out of its stack.
class text_pattern {
public:
  /// Throws std::invalid_argument for an expression outside that subset.
  explicit text_pattern(std::string_view expression);

  bool matches(std::string_view utf8) const;

private:
  /// A class of characters and how often one of it may stand here.
  struct part {
    std::vector<std::pair<char32_t, char32_t>> ranges;
    bool negated = false;
    uint32_t at_least = 1;
    uint32_t at_most = 1;

    bool takes(char32_t c) const;
  };

  class parser;

  std::vector<part> parts_;
};

} // namespace roscell
