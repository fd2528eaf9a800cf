#pragma once

#include "actors/edge/engine/program_libraries.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <map>
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

/// By path, what tells a file from what it was before and is after.
using file_marks = std::map<std::string, std::string>;

/// Its inode, size and times; empty: it is not there.
std::string mark_of(const std::filesystem::path& file);

/// Whether all of them are there and as they were. One look at each.
bool are_unchanged(const file_marks& marks);

/// Where an image has what comes from us.
constexpr const char* image_skill_dir = "/opt/roscell/skill";
constexpr const char* image_library_dir = "/opt/roscell/lib";

/// What the image of a skill is made from.
struct image_recipe {
  std::string operation;
  std::string skill;                    ///< Content hash of the skill folder.
  std::string base_image;               ///< Printable and without spaces.
  std::vector<std::string> entry_point; ///< Empty: the base image's program.
  std::vector<shared_library> libraries;
};

/// The Dockerfile for a context as write_build_context makes it. It names all
/// that goes into the image: another content gives another text.
std::string dockerfile_of(const image_recipe& recipe);

/// "roscell/<operation>:<32 hex digits>", as far as image names can have the
/// operation's characters; the digits are a hash of the Dockerfile.
std::string image_name(const std::string& operation,
                       const std::string& dockerfile);

} // namespace roscell
