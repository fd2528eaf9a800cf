#pragma once

#include "actors/edge/engine/program_libraries.hpp"

#include <string>
#include <vector>

namespace roscell {

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
