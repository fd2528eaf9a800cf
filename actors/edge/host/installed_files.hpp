#pragma once

#include <filesystem>
#include <vector>

/// Where the other programs and the skills lie that come with this one, as it
/// is built (BUILD/bin) and as it is installed (PREFIX/bin,
/// PREFIX/lib/roscell).
namespace roscell {

/// The folder of the program that this process runs. Empty if it is not known.
std::filesystem::path program_folder();

/// roscell-instance-shim: beside a program in `bin`, else where it is
/// installed. The file need not be there.
std::filesystem::path find_shim(const std::filesystem::path& bin);

/// The folder of the skills that are installed with a program in `bin`. It need
/// not be there.
std::filesystem::path installed_skills(const std::filesystem::path& bin);

/// Whether one of `folders` is this one, by whatever path.
bool names_folder(const std::vector<std::filesystem::path>& folders,
                  const std::filesystem::path& folder);

} // namespace roscell
