#pragma once

#include "actors/placement/scheduler.hpp"
#include "actors/placement/searcher.hpp"

#include <memory>
#include <utility>

namespace roscell::test {

/// A SCHEDULER whose searchers run on the test's own coordinator of actors.
inline scheduler_actor spawn_planner(caf::actor_system& system,
                                     const actor_context& context,
                                     std::shared_ptr<search_guard> guard) {
  scheduler_config config;
  config.guard = std::move(guard);
  config.make_searcher = [&system, context](auto live,
                                            const scheduler_actor& owner) {
    return spawn(system, context, searcher, context, live, owner);
  };
  return spawn(system, context, scheduler, config);
}

} // namespace roscell::test
