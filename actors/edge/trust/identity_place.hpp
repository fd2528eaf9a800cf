#pragma once

#include "actors/edge/trust/identity_file.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// The files of an identity. Beside FILE are FILE.issuer, by which a
/// coordinator makes identities of nodes, and FILE.revoked, the site's list.
namespace roscell {

std::filesystem::path issuing_file_of(const std::filesystem::path& file);
std::filesystem::path revoked_file_of(const std::filesystem::path& file);

/// By what whoever has that file makes identities of nodes. Errors: those of
/// `read_identity_file`; none where there is no such file.
edge_result<std::optional<own_identity>>
read_issuing(const std::filesystem::path& file);

/// All that somebody has for what he is.
struct kept_identity {
  own_identity own;
  std::string issuing{}; ///< Of a coordinator, as PEM; else empty.
  std::string revoked{}; ///< The site's list; may be empty.
};

/// Puts it there, the identity last, since with it the others count. What is
/// empty stays as it was. Blocks on the disk. Errors: internal.
std::optional<edge_error> keep_identity(const std::filesystem::path& file,
                                        const kept_identity& x);

/// The same for the list alone.
std::optional<edge_error> keep_revoked(const std::filesystem::path& file,
                                       const std::string& revoked);

} // namespace roscell
