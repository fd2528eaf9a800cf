#pragma once

#include <set>
#include <string>
#include <string_view>

namespace roscell::cli {

/// A JSON request that comes line by line, until its braces close. What is
/// wrong with it is said as soon as it is certain.
class json_collector {
public:
  /// Whether such a request begins with this line.
  static bool begins(std::string_view line);

  /// Takes a line without its end. Returns what is wrong so far and was not
  /// said before, with marks under the places; empty: nothing.
  std::string add_line(std::string_view line);

  /// Whether something has come that has not ended yet.
  bool is_open() const {
    return !text_.empty() && !ended_;
  }

  /// All lines, each with its end.
  const std::string& text() const {
    return text_;
  }

  /// The request in one line, for the history.
  std::string one_line() const;

  /// What is wrong with the whole request; empty: nothing.
  std::string errors() const;

private:
  /// What the last token of the text is, which says how it can be closed.
  enum class token { opening, comma, colon, name, value };

  void scan(std::string_view line);
  void scan_mark(char x);
  std::string closed_text() const;
  std::string new_errors();

  std::string text_;
  std::string open_; ///< The brackets that are open.
  token last_ = token::opening;
  bool ended_ = false;
  std::set<std::string> reported_; ///< The places.
};

} // namespace roscell::cli
