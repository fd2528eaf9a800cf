#pragma once

#include "tools/roscell/client/known_cell.hpp"
#include "tools/roscell/top/layout/listing.hpp"

#include <cstdint>

/// The lists that are shown, whole and in the order of their names.
namespace roscell::cli::top {

/// Each node with bars of its resources, and a line below it for each GPU.
listing list_nodes(const known_cell& known, int64_t now_unix_ms);
listing list_tasks(const known_cell& known, int64_t now_unix_ms);
listing list_instances(const known_cell& known, int64_t now_unix_ms);

} // namespace roscell::cli::top
