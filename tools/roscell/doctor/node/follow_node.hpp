#pragma once

#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/checked_host.hpp"

namespace roscell::cli {

/// Looks at the host with the node in mind that runs there: which ports it has,
/// and those of its cell, which no option of a member says. Throws as
/// `node_client` does.
void follow_node(checked_host& host, const node_client& node,
                 const node_description& reported);

} // namespace roscell::cli
