#pragma once

#include "messages/event.hpp"
#include "messages/node.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

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

// INTERNAL to descriptions: tables and words that several of them have.

table resources_table(const node_resources& r);
table events_table(const std::vector<event>& events, const view_style& style);
table instances_table(const std::vector<instance_row>& rows,
                      const view_style& style);

/// A row for each stream: whether it goes in or out, where, and what it does.
table ports_table(const instance_row& row);

/// A row for each parameter of an instance.
table parameters_table(const std::string& parameters);

/// "running, since 5m03s (2026-11-22 17:01:02)", or "unknown, ...".
std::string instance_state_text(const instance_row& row,
                                const view_style& style);

/// "5m03s ago (2026-11-22 17:01:02.345)"; empty for a time that is not known.
std::string time_and_age_text(int64_t unix_ms, const view_style& style);

/// "2026-11-28 06:30:00.000 if it still runs (timeout_s)"; empty if 0.
std::string deadline_text(int64_t unix_ms);

/// "cpu 1, memory 96 MiB, disk 150 MiB"
std::string resource_request_text(const resource_request& r);

} // namespace roscell::cli
