#pragma once

#include "tools/roscell/view/table.hpp"

#include <string>

namespace roscell::cli {

/// All that is known of one thing: events, then sections under their headings.
class page {
public:
  explicit page(const text_style& style) : style_{style} {}

  /// "Name:  value"; left out if the value is empty.
  void detail(const std::string& name, const std::string& value);

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

  const text_style& style_;
  std::string text_;
};

} // namespace roscell::cli
