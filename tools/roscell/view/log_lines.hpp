#pragma once

#include "messages/kept_log.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace roscell::cli {

/// A line of a log, without its end, as a terminal may get it: without colours,
/// and with '?' for whatever else would steer it.
std::string harmless_line(std::string_view line);

/// Who reads a log.
enum class log_reader {
  program, ///< The text stays as it is.
  terminal ///< Each line is a harmless one.
};

/// Puts a name before each line of a log, so that the logs of several instances
/// can stand in one. A line may come in parts.
class log_lines {
public:
  /// Before each line; empty: there is none.
  log_lines(std::string prefix, log_reader reader)
      : prefix_{std::move(prefix)}, reader_{reader} {}

  /// What is to be printed of a part. For a terminal a line is kept until its
  /// end has come.
  std::string add(std::string_view part);

  /// What is kept of a line that has no end.
  std::string finish();

private:
  std::string prefixed(std::string_view part);

  std::string prefix_;
  log_reader reader_;
  std::string kept_;
  bool in_line_ = false;
};

/// The logs of instances that are gone, and below them what is missing.
std::string kept_logs_view(const kept_logs& logs, const view_style& style);

} // namespace roscell::cli
