#pragma once

#include <filesystem>
#include <string>

namespace roscell::cli {

/// That everybody on this machine can read a file that holds a secret, and the
/// remedy. Empty if that is not so.
std::string open_secret_warning(const std::filesystem::path& file);

} // namespace roscell::cli
