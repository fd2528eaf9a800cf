#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <functional>
#include <string>

namespace roscell::cli {

/// Shows what `fetch` gets now and after every event of the node, on a screen
/// that is drawn anew, or as one JSON document per line whenever it differs
/// from the last. Events that arrive while it works are answered by one
/// fetch. Ends when the node goes, with command_error, or with Ctrl-C.
int watch(const node_client& node, bool as_json,
          const std::function<json()>& fetch,
          const std::function<std::string(const json&)>& view);

} // namespace roscell::cli
