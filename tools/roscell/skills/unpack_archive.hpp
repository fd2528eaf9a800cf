#pragma once

#include <filesystem>

namespace roscell::cli {

/// Has a program of its own unpack an archive of a skill into an empty folder,
/// and gives the skill's folder in it. Throws command_error.
std::filesystem::path unpack_archive(const std::filesystem::path& archive,
                                     const std::filesystem::path& into);

} // namespace roscell::cli
