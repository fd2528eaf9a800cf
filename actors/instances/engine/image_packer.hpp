#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/engine/build_context.hpp"
#include "actors/edge/engine/registry_login.hpp"
#include "messages/messages.hpp"

#include <filesystem>
#include <string>

namespace roscell {

/// Prepares one image on the disk. It is spawned as one that blocks, and only
/// for as long as one image is being made.
struct image_packer_state {
  static constexpr const char* name = "image-packer";

  std::filesystem::path work_dir;
  login_places logins;
  image_content content; ///< Of the image that was planned last.
  prepare_image request; ///< For which it was planned.
  file_marks made_of;    ///< The same.
};

/// The IMAGE PACKER. Messages: messages/inside/engine.hpp. Ends with its owner.
image_packer_actor::behavior_type
image_packer(image_packer_actor::stateful_pointer<image_packer_state> self,
             const std::filesystem::path& work_dir, const login_places& logins,
             const engine_runtime_actor& owner);

} // namespace roscell
