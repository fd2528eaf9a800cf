#pragma once

#include "messages/instance.hpp"
#include "messages/kept_log.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/view/log_lines.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace roscell::cli {

/// The coordinator asks its members, which answer at once.
constexpr std::chrono::seconds log_limit{30};

/// What of a log is printed.
struct log_request {
  bool follow = false;
  bool times = false;
  uint64_t tail = 0; ///< 0: all that is there.
};

/// Prints the log of one instance, each line behind a name where there are
/// several.
class log_printer {
public:
  /// @param subject the instance, and whose kept log.
  log_printer(const log_request& request, const node_client& node,
              log_query subject, const std::string& prefix);

  void run();

private:
  log_excerpt ask(const log_query& query) const;
  void print_all();
  void print_end();
  std::string stream_path() const;

  const log_request& request_;
  const node_client& node_;
  log_query subject_;
  log_lines lines_;
};

} // namespace roscell::cli
