#include "tools/roscell/shell_word.hpp"

#include <string_view>

namespace roscell::cli {

namespace {

constexpr std::string_view plain_letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=,@%+";

} // namespace

std::string shell_word(const std::string& word) {
  if (!word.empty() && word.find_first_not_of(plain_letters) == word.npos)
    return word;
  std::string result = "'";
  for (const char x : word)
    result += x == '\'' ? std::string{"'\\''"} : std::string{x};
  return result + "'";
}

} // namespace roscell::cli
