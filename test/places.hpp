#pragma once

#include <filesystem>
#include <string>

namespace roscell::test {

/// Where things are, of this clone. Told by functions, since a definition for
/// the compiler would be another in each clone, and no object would be found in
/// ccache.
std::filesystem::path source_dir();
std::filesystem::path build_dir();

/// A library that answers as NVIDIA's does.
std::string fake_nvml();

/// A program one of whose libraries is not found.
std::string lacking_program();

/// The interpreter that the build uses.
std::string python();

} // namespace roscell::test
