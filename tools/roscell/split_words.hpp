#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::cli {

/// A line as a shell splits it: blanks separate words, quotes of both kinds and
/// the backslash keep what they have a meaning for.
struct split_line {
  std::vector<std::string> words;
  size_t last_begin = 0; ///< Byte where the word begins that the line ends in.
  bool in_word = false;  ///< The line ends in a word, not behind one.
  /// Quote that is still open; '\\' for a backslash with nothing behind it.
  char open = '\0';
};

/// Nothing is expanded: neither variables nor `*`.
split_line split_words(std::string_view line);

/// The words of a line without the `roscell` that it may begin with from habit.
std::vector<std::string> without_program(std::vector<std::string> words);

/// A word as a shell has to be given it so that it stays one word and nothing
/// in it is expanded; as it is where it may be.
std::string shell_word(const std::string& word);

} // namespace roscell::cli
