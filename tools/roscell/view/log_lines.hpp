#pragma once

#include <string>
#include <string_view>

namespace roscell::cli {

/// Puts a name before each line of a log, so that the logs of several instances
/// can stand in one. A line may come in parts.
class log_lines {
public:
  /// Before each line; empty: the text stays as it is.
  explicit log_lines(std::string prefix) : prefix_{std::move(prefix)} {}

  /// What is to be printed of a part.
  std::string add(std::string_view part);

private:
  std::string prefix_;
  bool in_line_ = false;
};

} // namespace roscell::cli
