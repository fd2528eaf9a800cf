#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// An image as it lies in a folder on its way to another engine. Whichever
/// engine has saved it, the same image gives the same files:
///
///     manifest.json    of one image without a name: its config and its layers
///     DIGITS.json      the config, whose SHA-256 is the image's id
///     DIGITS.tar       each layer, by its diff id; those that the other engine
///                      has are left out
namespace roscell {

/// Makes such a folder of what an engine has saved, an unpacked archive of
/// `docker save`, whose files are moved from there.
/// @param layers_there of the lowest layers so many are left out.
/// Errors: engine_failed (it is no such archive, or that of another image; an
/// engine whose ids are no hashes of configs saves such ones), internal (the
/// disk).
std::optional<edge_error>
make_image_folder(const std::filesystem::path& unpacked,
                  const std::filesystem::path& folder, const std::string& id,
                  size_t layers_there);

/// Whether a folder that came from another node holds that image, and nothing
/// else that an engine would look at. Gives its files, as they are to be
/// packed. Errors: schema_violation.
edge_result<std::vector<std::string>>
check_image_folder(const std::filesystem::path& folder, const std::string& id);

} // namespace roscell
