#pragma once

#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/io_core.hpp"
#include "roscell/web_page.hpp"

#include <memory>
#include <string>

namespace roscell::cli {

/// The dashboard: the files of tools/dashboard, and what it is told of this
/// program's own.
const web_pages& dashboard_pages();

/// The files of tools/dashboard alone.
const web_pages& page_files();

/// A script that exports COLUMNS, in which things of a kind are listed, and
/// STALE, which answers of the node an event makes old: as this program has
/// them itself.
const std::string& described_script();

/// Answers a browser: pages are shown as they are, everything below /v1/ is
/// asked of the node, streams too. What it asks with is the user's own.
http_handler make_forwarding(const std::shared_ptr<io_core>& core,
                             const http_endpoint& node, const web_pages& pages);

} // namespace roscell::cli
