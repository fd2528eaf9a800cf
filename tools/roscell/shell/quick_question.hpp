#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <string>

namespace roscell::cli {

/// A question for whose answer nobody waits long.
struct quick_question {
  std::string path = "/v1/requests";
  std::string body; ///< A request; empty: the path says it all.
};

/// The answer of a node within `limit`, unless `cancel` ends the wait from
/// another thread. Throws as `node_client` does.
json ask_quickly(const node_client& node, const quick_question& question,
                 std::chrono::milliseconds limit,
                 const http_cancel* cancel = nullptr);

} // namespace roscell::cli
