#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

/// Which of the images that were built for skills are kept.
namespace roscell {

/// An image that we have built.
struct built_image {
  std::string name; ///< "roscell/echo:0123..."
  std::string id;
  int64_t created_unix_s = 0;
};

/// Of an engine's list of images (GET /images/json) those that are ours.
std::vector<built_image> built_images_in(const nlohmann::json& images);

/// The images of an engine's containers, whatever state they are in
/// (GET /containers/json?all=1).
std::set<std::string> used_images_in(const nlohmann::json& containers);

/// What is to be removed, by name, the oldest first: no container has it, no
/// instance of this node names it, and so many newer ones of that kind there
/// are.
std::vector<std::string> images_to_remove(std::vector<built_image> images,
                                          const std::set<std::string>& used,
                                          const std::set<std::string>& named,
                                          size_t kept);

} // namespace roscell
