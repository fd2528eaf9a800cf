#pragma once

#include <filesystem>

namespace roscell {

/// Makes a folder for this user alone where everybody may make one, unless it
/// is there. Returns false with errno set when it cannot be made, or, with
/// EPERM, when somebody else was there first and could change what is in it.
bool make_own_folder(const std::filesystem::path& path);

} // namespace roscell
