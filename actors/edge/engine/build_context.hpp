#pragma once

#include "actors/edge/engine/program_libraries.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace roscell {

/// What goes into the image of a skill.
struct image_content {
  std::string dockerfile;
  std::filesystem::path skill_dir;       ///< Becomes opt/roscell/skill.
  std::vector<shared_library> libraries; ///< Become opt/roscell/lib/NAME.
};

/// Writes the build context, a tar file, into the folder `work_dir`, which is
/// made if need be. Whoever has used the file removes it. The same content
/// gives the same bytes: owners and times are left out. Blocks on the disk for
/// as long as copying the skill takes.
///
/// Errors: engine_failed (the disk is full, a file cannot be read).
edge_result<std::filesystem::path>
write_build_context(const image_content& content,
                    const std::filesystem::path& work_dir);

/// Removes what an interrupted build has left in the folder.
void clean_build_contexts(const std::filesystem::path& work_dir);

} // namespace roscell
