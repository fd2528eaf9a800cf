#pragma once

#include "actors/edge/site/site_secret.hpp"
#include "roscell/node_config.hpp"

#include <caf/expected.hpp>

#include <filesystem>
#include <string>

/// The secrets that a node has in files. Least and most lengths:
/// `limits::token`.
namespace roscell {

/// The bearer token for HTTP over TCP, in a file that only its owner can read;
/// made where there is none. Errors: internal (no permission, disk full).
caf::expected<std::string> load_bearer_token(const std::filesystem::path& file);

/// What proves the node to others of its site: the file that the configuration
/// names, or that of this user, which a coordinator makes where there is none.
/// Another node may learn of it later. Errors: those of `read_site_token` and
/// `make_site_token`.
caf::expected<site_secret> load_site_secret(const node_config& config);

} // namespace roscell
