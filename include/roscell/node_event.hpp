#pragma once

#include <cstdint>
#include <string>

namespace roscell {

/// An event of a node, as `roscell events` shows it.
struct node_event {
  std::uint64_t sequence = 0; ///< Counts from 1 at every start of the node.
  std::int64_t time_unix_ms = 0;
  std::string what;    ///< A past participle, such as "node_joined".
  std::string subject; ///< A node, task or instance.
  std::string data;    ///< A JSON object with the particulars, or empty.
};

} // namespace roscell
