#pragma once

#include "actors/edge/disk/build_manifest.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <filesystem>
#include <functional>

namespace roscell::cli {

/// What has come of an upload: bytes of all.
using upload_progress = std::function<void(uint64_t done, uint64_t all)>;

/// Brings a build to the node, piece by piece; what it has already is not sent
/// again. Throws `refused` or command_error.
void upload_build(const node_client& node, const std::filesystem::path& folder,
                  const described_build& build,
                  const upload_progress& on_progress);

} // namespace roscell::cli
