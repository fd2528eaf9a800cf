#include "tools/roscell/split_words.hpp"

#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::string_view word_blanks = " \t\r\n";

/// Reads a line byte by byte.
class word_splitter {
public:
  void add(char x, size_t at) {
    if (result_.open == '\\')
      add_escaped(x);
    else if (result_.open != '\0')
      add_quoted(x);
    else
      add_plain(x, at);
  }

  split_line finish() && {
    if (result_.in_word)
      result_.words.push_back(word_);
    return std::move(result_);
  }

private:
  void add_escaped(char x) {
    // Between double quotes it keeps the two that have a meaning there only.
    if (in_double_quotes_ && x != '"' && x != '\\')
      word_ += '\\';
    word_ += x;
    result_.open = in_double_quotes_ ? '"' : '\0';
  }

  void add_quoted(char x) {
    if (x == result_.open) {
      result_.open = '\0';
      in_double_quotes_ = false;
    } else if (x == '\\' && in_double_quotes_) {
      result_.open = '\\';
    } else {
      word_ += x;
    }
  }

  void add_plain(char x, size_t at) {
    if (word_blanks.find(x) != word_blanks.npos)
      return end_word();
    if (!std::exchange(result_.in_word, true))
      result_.last_begin = at;
    if (x != '\'' && x != '"' && x != '\\') {
      word_ += x;
      return;
    }
    result_.open = x;
    in_double_quotes_ = x == '"';
  }

  void end_word() {
    if (std::exchange(result_.in_word, false))
      result_.words.push_back(std::exchange(word_, {}));
  }

  split_line result_;
  std::string word_;
  bool in_double_quotes_ = false;
};

} // namespace

split_line split_words(std::string_view line) {
  word_splitter splitter;
  for (size_t i = 0; i < line.size(); ++i)
    splitter.add(line[i], i);
  auto result = std::move(splitter).finish();
  if (!result.in_word)
    result.last_begin = line.size();
  return result;
}

std::vector<std::string> without_program(std::vector<std::string> words) {
  if (!words.empty() && words.front() == "roscell")
    words.erase(words.begin());
  return words;
}

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
