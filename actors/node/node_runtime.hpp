#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/cgroup/cgroup_place.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/instances/exec/exec_host.hpp"
#include "actors/instances/skills/skill_catalogue.hpp"
#include "actors/instances/skills/skill_places.hpp"
#include "messages/messages.hpp"
#include "roscell/node_config.hpp"

#include <caf/expected.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace roscell {

/// What runs the instances of a node.
struct chosen_runtime {
  std::string name;           ///< "process", "docker" or "podman".
  std::string socket;         ///< Of the engine; empty: there is none.
  std::string api;            ///< Version of Docker's API that is spoken.
  bool rootless = false;      ///< The engine runs without root.
  std::filesystem::path shim; ///< For processes, and for fences.
  std::string reason;         ///< Why this one, a sentence for the operator.
  cgroup_place cgroups;       ///< For processes.
  std::string limits; ///< What holds instances to their limits, or why none.
};

/// Finds what the configuration asks for; `auto` takes an engine if one answers
/// and processes if none does. Waits for an engine's answer, 2 s at most.
///
/// Errors: schema_violation (an unknown runtime), unreachable, unauthorized,
/// timeout or engine_failed (the engine that was asked for), engine_failed
/// (the shim is missing).
caf::expected<chosen_runtime> choose_runtime(const node_config& config);

/// Finds where instances are held to their limits, and makes the node's place.
void find_limits(const node_config& config, const std::string& node_uuid,
                 chosen_runtime& chosen);

/// Spawns the runtime that was chosen.
std::function<runtime_actor(container_listener_actor)>
runtime_factory(caf::actor_system& system, const actor_context& context,
                const node_config& config, const chosen_runtime& chosen,
                const std::string& node_uuid, const io_thread& io,
                const node_history_actor& history,
                const image_exchange_actor& images);

/// Tells instances of that runtime, while they run, of other values of
/// variables.
environment_writer make_environment_writer(const node_config& config,
                                           const chosen_runtime& chosen);

/// The same of other parameters.
parameter_writer make_parameter_writer(const node_config& config,
                                       const chosen_runtime& chosen);

/// Of that, what tells a program what has become of a request.
request_answerer make_request_answerer(const node_config& config,
                                       const chosen_runtime& chosen);

/// Begins commands beside the instances of that runtime.
exec_opener make_exec_opener(const node_config& config,
                             const chosen_runtime& chosen, const io_thread& io);

/// Where builds lie that come from other nodes.
std::filesystem::path builds_folder(const node_config& config);

/// Where a node looks for skills. Makes the folder for them in its data
/// directory, which is there.
skill_places skill_places_of(const node_config& config);

/// The skills in these places, and those whose instances are actors of this
/// process, by their descriptors. Blocks on the disk. What is wrong in a folder
/// is among the problems of the catalogue.
///
/// Errors: schema_violation (a descriptor in `actor_skills`).
caf::expected<shared_skill_catalogue>
offered_skills(const skill_places& places, const chosen_runtime& runtime,
               const std::vector<std::string>& actor_skills);

} // namespace roscell
