#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "embedding/skills/messages.hpp"
#include "embedding/skills/skill_side.hpp"
#include "skills/engine/life/processing_times.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace roscell::embedding {

/// What the keeper tells the runtime of its instance; each may be called from
/// any thread.
struct keeper_reports {
  std::function<void(const instance_notified&)> notified;
  std::function<void(int exit_code)> ended;
};

struct skill_keeper_config {
  std::string instance;
  std::shared_ptr<actor_skill_context::impl> side;
  actor_skill_factory make;
  keeper_reports reports;
};

/// Owns one instance: its actor and its streams. Opening and closing these
/// blocks, so that it is spawned detached; the instance is a scheduled actor.
struct skill_keeper_state {
  static constexpr const char* name = "skill-keeper";

  skill_keeper_config config;
  actor_skill_instance skill; ///< Null before it is made and when it has ended.
  bool busy = false;          ///< A frame is being handled.
  bool ending = false;
  uint64_t failed = 0;
  std::unique_ptr<engine::processing_times> times;
  std::chrono::steady_clock::time_point frame_begun;
  alarm::time_point safety_quiet_until; ///< No word on safety is told before.
  /// When one is told that came earlier; max(): none did.
  alarm::time_point safety_due = alarm::time_point::max();
  /// When the instance is asked whether it lives; max(): it is being asked.
  alarm::time_point life_due = alarm::time_point::max();
  /// When one that is asked to end is ended.
  alarm::time_point force_due = alarm::time_point::max();
  alarm timer;
};

/// The KEEPER. Gives the instance one frame at a time, asks it for signs of
/// life, and ends it. Ends with it.
skill_keeper_actor::behavior_type
skill_keeper(skill_keeper_actor::stateful_pointer<skill_keeper_state> self,
             const skill_keeper_config& config);

} // namespace roscell::embedding
