#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <filesystem>
#include <string>

/// Skills on their way into a cell and out of it.
namespace roscell::cli {

/// What the skill of a folder or archive is known by. Throws command_error.
std::string build_hash_of(const std::string& source);

/// Where its signature is, if it has one: beside it.
std::filesystem::path signature_file_of(const std::string& source);

/// Brings the skill of a folder or archive to the node and adds it to the cell,
/// with its signature if there is one.
/// Gives the `skill_added`.
/// @param hash that it must have; empty: any.
/// @param as_json how a refusal is shown. Throws `refused` or command_error.
json add_to_cell(const node_client& node, const std::string& source,
                 const std::string& hash, bool as_json);

/// Copies a build of the cell into a folder that is not there yet. Gives the
/// `skill_pulled`.
/// @param build the first digits of its hash; empty: the newest one. Throws as
/// above.
json pull_from_cell(const node_client& node, const std::string& operation,
                    const std::string& build,
                    const std::filesystem::path& folder, bool as_json);

} // namespace roscell::cli
