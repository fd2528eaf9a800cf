#pragma once

#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <memory>
#include <string>
#include <vector>

/// The node that runs on this host.
namespace roscell::cli {

/// What the node finds that runs here. It is asked once, by the first of these
/// checks.
std::vector<check> own_checks(const std::shared_ptr<const node_client>& node,
                              const std::vector<check>& checks);

/// Looks at the host with the node in mind that runs there: which ports it has,
/// and those of its cell, which no option of a member says. Throws as
/// `node_client` does.
void follow_node(checked_host& host, const node_client& node,
                 const node_description& reported);

/// Asks the node of `host.config` for it. What its options do not say, it knows
/// itself; the host of one that does not answer is looked at by its options.
void follow_node_of(checked_host& host);

} // namespace roscell::cli
