#pragma once

#include <string>
#include <string_view>

/// The names of container images.
namespace roscell {

/// What a name says of where an image is.
struct image_reference {
  std::string registry;   ///< "docker.io", "127.0.0.1:5000"
  std::string repository; ///< "library/debian"
  std::string name;       ///< As it was written, without tag and digest.
  std::string tag;        ///< "latest" where neither it nor a digest is said.
  std::string digest;     ///< "sha256:..."; empty: none.
  std::string id;         ///< It is the id of an image, and in no registry.
};

/// As engines read it: the first part is a registry if it can be no other name.
image_reference parse_image_reference(std::string_view text);

/// Whether a text is what engines call images by: "sha256:" and 64 digits.
bool is_image_id(std::string_view text);

/// The name as a part of a path of an engine's API.
std::string image_path(std::string_view image);

/// Under which name an engine knows an image that came from another node: that
/// of a digest, which no engine gives to an image that it has not pulled, is
/// one of ours.
std::string name_in_engine(const std::string& image);

} // namespace roscell
