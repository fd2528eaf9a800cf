#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"

#include <set>
#include <string>

namespace roscell {

/// What stands for the image of an actor skill. No engine's image is called so:
/// a registry has no name without a letter before its first slash.
std::string actor_image(const std::string& operation);

/// Which of two runtimes an instance is of.
struct runtime_switch_state {
  static constexpr const char* name = "runtime-switch";

  runtime_actor programs;
  runtime_actor actors;
  std::set<std::string> in_process; ///< Instances that have been actors here.
};

/// The RUNTIME SWITCH: the runtime of a node that is embedded in a program with
/// actor skills. Passes on what is asked to the runtime of programs, or to that
/// of actors. Ends with either of them, and with its listener.
runtime_actor::behavior_type
runtime_switch(runtime_actor::stateful_pointer<runtime_switch_state> self,
               runtime_actor programs, runtime_actor actors,
               container_listener_actor listener);

} // namespace roscell
