#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace roscell {

/// By path, what tells a file from what it was before and is after.
using file_marks = std::map<std::string, std::string>;

/// Its inode, size and times; empty: it is not there.
std::string mark_of(const std::filesystem::path& file);

/// Whether all of them are there and as they were. One look at each.
bool are_unchanged(const file_marks& marks);

} // namespace roscell
