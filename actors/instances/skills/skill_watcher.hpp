#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/disk/folder_watch.hpp"
#include "actors/instances/skills/current_skills.hpp"
#include "actors/instances/skills/folder_unrest.hpp"
#include "actors/instances/skills/skill_places.hpp"
#include "messages/messages.hpp"

#include <memory>
#include <optional>
#include <string>

namespace roscell {

struct skill_watcher_config {
  actor_context context;
  std::string node; ///< Its name, for events.
  skill_places places;
  shared_skills skills; ///< As they were read at first.
  skill_listener_actor listener;
  std::shared_ptr<io_core> io; ///< Null: nothing is watched.
};

/// Keeps the node's skills as they lie in their folders.
struct skill_watcher_state {
  static constexpr const char* name = "skill-watcher";

  skill_watcher_config config;
  std::optional<folder_watch> watch;
  std::string unwatched; ///< Why not all folders are watched; empty: all are.
  folder_unrest unrest;
  skills_changed reported; ///< What the listener knows.
  uint64_t readings = 0;
  alarm timer;
};

/// The SKILL WATCHER. Messages: messages/inside/runtime.hpp.
skill_watcher_actor::behavior_type
skill_watcher(skill_watcher_actor::stateful_pointer<skill_watcher_state> self,
              const skill_watcher_config& config);

} // namespace roscell
