#pragma once

#include <filesystem>
#include <string>

namespace roscell {

/// Replaces the file by one with this text, which outlives a loss of power: a
/// reader finds the whole of the old one or of the new one. Returns why it
/// cannot, empty if it could.
std::string write_lasting(const std::filesystem::path& file,
                          const std::string& text);

} // namespace roscell
