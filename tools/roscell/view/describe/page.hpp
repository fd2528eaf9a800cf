#pragma once

#include "tools/roscell/view/table.hpp"

#include <string>

namespace roscell::cli {

/// All that is known of one thing: events, then sections under their headings.
class page {
public:
  /// @param mark stands behind a name.
  /// @param column where values begin.
  explicit page(const text_style& style, const char* mark = ":",
                size_t column = 16)
      : style_{style}, mark_{mark}, column_{column} {}

  /// "Name:  value"; left out if the value is empty.
  void detail(const std::string& name, const std::string& value);

  /// The same for a sentence, which is read to its end: it goes on in the next
  /// line, under its beginning.
  void sentence(const std::string& name, const std::string& text);

  /// A table under a heading; "none" if it has no rows.
  void section(const std::string& heading, const table& rows);

  /// Lines under a heading; left out if there are none.
  void section(const std::string& heading, const std::string& lines);

  /// Columns of a line in a section; 0: no bound.
  static size_t inner_width(size_t width);

  std::string text() const {
    return text_;
  }

private:
  void put(const std::string& heading, const std::string& lines);

  void put_name(const std::string& name);

  const text_style& style_;
  std::string mark_;
  size_t column_;
  std::string text_;
};

} // namespace roscell::cli
