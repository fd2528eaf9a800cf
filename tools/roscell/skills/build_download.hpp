#pragma once

#include "messages/build.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <filesystem>

namespace roscell::cli {

/// Writes a build that a node has into a folder, which is not there before.
/// Nothing of it is left where that fails. Throws as `node_client` does, and
/// command_error where a file cannot be written, or the node gives other bytes
/// than the build's.
void download_build(const node_client& node, const build_name& build,
                    const std::filesystem::path& folder);

} // namespace roscell::cli
