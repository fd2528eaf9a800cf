#pragma once

#include <string>

namespace roscell::cli {

/// The bytes of a file, or of standard input for "-". Throws command_error if
/// it cannot be read, or is larger than any node would take (256 MiB).
std::string read_file(const std::string& name);

} // namespace roscell::cli
