#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace roscell {

/// The content of a file, e.g. of a record that another program has written.
/// Nothing if it cannot be read or is longer than `max_bytes`.
std::optional<std::string> read_small_file(const std::filesystem::path& path,
                                           size_t max_bytes);

} // namespace roscell
