#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/engine/image_inspection.hpp"
#include "messages/messages.hpp"

#include <filesystem>

namespace roscell {

struct image_worker_config {
  engine_door door;
  std::filesystem::path work_dir; ///< On the disk of the node's builds.
};

/// Owns what it makes on the disk until it answers. Spawned as one that blocks:
/// it waits for the engine, and does one thing after the other.
struct image_worker_state {
  static constexpr const char* name = "image-worker";

  image_worker_config config;
};

/// The IMAGE WORKER. Messages: messages/inside/images.hpp. Ends with its owner.
image_worker_actor::behavior_type
image_worker(image_worker_actor::stateful_pointer<image_worker_state> self,
             const image_worker_config& config,
             const image_exchange_actor& owner);

} // namespace roscell
