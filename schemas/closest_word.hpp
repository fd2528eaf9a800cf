#pragma once

#include <string_view>
#include <vector>

namespace roscell {

/// The one of `words` that `typed` was probably meant to be: the nearest in
/// insertions, deletions and replacements, if at most a third of its characters
/// differ. Empty if none is near, or if `typed` is longer than any word.
std::string_view closest_word(std::string_view typed,
                              const std::vector<std::string_view>& words);

} // namespace roscell
