#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <filesystem>

namespace roscell {

/// Gives `file` the first free of the names file.aside-1, file.aside-2, and so
/// on, with all that is named like it and a dash (what SQLite keeps beside its
/// file). Returns the new path; an empty one if there is no such file.
/// Errors: internal.
edge_result<std::filesystem::path> put_aside(const std::filesystem::path& file);

} // namespace roscell
