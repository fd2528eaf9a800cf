#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

/// Whom a coordinator has made identities for: without it nobody could revoke
/// one that is away. A file beside its own, FILE.issued, a line for each.
namespace roscell {

using issued_names = std::map<std::string, std::string>; ///< By UUID.

std::filesystem::path issued_file_of(const std::filesystem::path& file);

/// Empty where there is none; lines that make no sense are left out.
issued_names read_issued(const std::filesystem::path& file);

/// Writes all of them, at most `limits::trust::issued`. Why it cannot; empty:
/// it could. Blocks on the disk.
std::string keep_issued(const std::filesystem::path& file,
                        const issued_names& all);

} // namespace roscell
