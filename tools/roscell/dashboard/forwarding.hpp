#pragma once

#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/io_core.hpp"
#include "roscell/web_page.hpp"

#include <memory>

namespace roscell::cli {

/// Answers a browser: pages are shown as they are, everything below /v1/ is
/// asked of the node, streams too. What it asks with is the user's own.
http_handler make_forwarding(const std::shared_ptr<io_core>& core,
                             const http_endpoint& node, const web_pages& pages);

} // namespace roscell::cli
