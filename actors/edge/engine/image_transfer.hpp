#pragma once

#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/engine/image_inspection.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Images on their way from one engine to another. All of these wait: for the
/// engine, the disk and tar.
namespace roscell {

/// What is to be saved.
struct image_saving {
  std::string id;
  std::vector<std::string> chains; ///< Layers that need not come.
  std::filesystem::path work_dir;  ///< Empty, of the caller's own.
  uint64_t most_bytes = 0;
};

/// An image in a folder, see actors/edge/engine/image_folder.hpp.
struct image_in_folder {
  std::filesystem::path folder; ///< In `work_dir`.
  described_build build;
};

/// Has the engine save an image. What is left of it after an error is in
/// `work_dir`.
/// Errors: conflict (it is larger than `most_bytes`, or the disk has too little
/// room), engine_failed, internal (the disk).
edge_result<image_in_folder> save_image_of(const engine_door& door,
                                           const image_saving& what);

/// What is to be loaded.
struct image_loading {
  std::string id;                 ///< What must come of it.
  std::string image;              ///< Its name.
  std::filesystem::path folder;   ///< As `save_image_of` has made it.
  std::filesystem::path work_dir; ///< Empty, of the caller's own.
};

/// Has the engine load an image and call it by its name. What it knows then as
/// something else is removed.
/// Errors: schema_violation (it is another image), conflict (too little room),
/// engine_failed, internal (the disk).
std::optional<edge_error> load_image_of(const engine_door& door,
                                        const image_loading& what);

} // namespace roscell
