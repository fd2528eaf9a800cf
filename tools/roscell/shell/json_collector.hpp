#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace roscell::cli {

/// A JSON request that comes line by line, until its braces close.
class json_collector {
public:
  /// Whether such a request begins with this line.
  static bool begins(std::string_view line);

  /// Takes a line without its end.
  void add_line(std::string_view line);

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

  /// What is wrong with the whole request, with marks under the places; empty:
  /// nothing.
  std::string errors() const;

private:
  std::string text_;
  size_t open_ = 0; ///< Brackets that are open.
  bool ended_ = false;
};

} // namespace roscell::cli
