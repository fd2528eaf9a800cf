#pragma once

#include <caf/expected.hpp>

#include <filesystem>
#include <string>

/// The secrets that a node has in files. Least and most lengths:
/// `limits::token`.
namespace roscell {

/// The bearer token for HTTP over TCP, in a file that only its owner can read;
/// made where there is none. Errors: internal (no permission, disk full).
caf::expected<std::string> load_bearer_token(const std::filesystem::path& file);

/// The token that proves nodes of one site to each other, which the operator
/// has put there. Errors: unauthorized (not readable, too short, too long).
caf::expected<std::string> load_site_token(const std::filesystem::path& file);

} // namespace roscell
