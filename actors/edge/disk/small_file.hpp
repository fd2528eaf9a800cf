#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// The content of a file, e.g. of a record that another program has written.
/// Nothing if it cannot be read or is longer than `max_bytes`.
std::optional<std::string> read_small_file(const std::filesystem::path& path,
                                           size_t max_bytes);

/// Writes all of `bytes`, however often the kernel takes a part only. False
/// with errno set: some of it may have been written.
bool write_whole(int fd, std::string_view bytes);

/// Replaces the file by one with this text, which outlives a loss of power: a
/// reader finds the whole of the old one or of the new one. Returns why it
/// cannot, empty if it could.
std::string write_lasting(const std::filesystem::path& file,
                          const std::string& text);

} // namespace roscell
