#pragma once

#include "roscell/actor_skill.hpp"
#include "roscell/coded_error.hpp"
#include "roscell/node_actors.hpp"
#include "roscell/node_calls.hpp"
#include "roscell/node_config.hpp"
#include "roscell/node_facts.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace caf {
class actor_system;
class actor_system_config;
} // namespace caf

namespace roscell {

/// The threads of an embedded node, and where they may run. All of them, those
/// of DDS and the disk too, get `cpus` and `nice`, the ordinary scheduling
/// policy whatever the calling thread has, and take no signals.
struct node_threads {
  /// Of the node's actors. Some of its actors have a thread of their own, which
  /// waits; docs/embedding.md counts them.
  std::size_t workers = 1;
  std::size_t skill_workers = 1; ///< Of actor skills; unused without any.
  /// Cores, counted from 0; empty: those of the calling thread.
  std::vector<unsigned> cpus;
  int nice = 0; ///< 0 to 19; what the calling thread has, if that is more.
};

/// What an embedded node is made of.
struct node_setup {
  node_config node;
  node_threads threads;
  std::vector<actor_skill> skills;
  node_callbacks calls;
};

/// A node cannot start, or has refused what it was asked, with the code of the
/// refusal. `code` is a word of docs/protocols.md: of a start "conflict" (a
/// port or the data directory is in use), "unreachable", "unauthorized",
/// "schema_violation" (a bad option or descriptor, named), "engine_failed" (no
/// program can be run).
class node_error : public coded_error {
public:
  using coded_error::coded_error;
};

/// Does nothing: an actor system that a node is to live in has to know nothing
/// of it. Programs that were written for version 0.2.0 call it.
inline void add_message_types(caf::actor_system_config& /*config*/) {}

/// A node inside this program, like the one that `roscell node` runs. Any
/// number of them may live in one program, each with a data directory of its
/// own. It changes nothing of the process: no signal handler, environment,
/// locale, limit or setting of a library; it throws from its constructor only
/// and never ends the process.
///
/// Where the process's environment would mislead DDS the node refuses to start:
/// ROS_DISCOVERY_SERVER, FASTDDS_ENVIRONMENT_FILE or
/// FASTRTPS_DEFAULT_PROFILES_FILE is set, or DEFAULT_FASTRTPS_PROFILES.xml lies
/// in the working directory and SKIP_DEFAULT_XML is not 1.
///
/// The functions may be called from any thread but those of its own actors.
class embedded_node {
public:
  /// Starts it in an actor system of its own. Blocks until its ports are open:
  /// some 0.1 s. Throws node_error.
  explicit embedded_node(const node_setup& setup);

  /// The same in `system`, which outlives it; `workers` is then the system's
  /// affair. Actor skills have workers of their own here, too.
  embedded_node(caf::actor_system& system, const node_setup& setup);

  /// Stops it. Waits for what still runs as long as it takes.
  ~embedded_node();

  embedded_node(const embedded_node&) = delete;
  embedded_node& operator=(const embedded_node&) = delete;

  const node_facts& facts() const noexcept;

  /// For actors that ask the node by messages, of any actor system.
  node_door_actor door() const;

  // -- tasks of the node's cell ----------------------------------------------
  // A member passes these on to its coordinator. They wait on the calling
  // thread, for `limit` at most, and throw node_error: the refusal, or
  // "timeout".

  /// Runs a task: `request` is what `roscell run` takes, as JSON or YAML.
  /// Returns once all its steps run. One that runs already stays as it is.
  task_status run(const std::string& request,
                  std::chrono::milliseconds limit = std::chrono::minutes{2});

  /// Ends a task. What has to be stop-safe before it ends may outlive the call,
  /// unless it is forced.
  void stop(const std::string& task, bool force = false,
            std::chrono::milliseconds limit = std::chrono::minutes{2});

  /// How a task stands; its state is "gone" if the cell has none of that name.
  task_status state(const std::string& task,
                    std::chrono::milliseconds limit = std::chrono::seconds{
                        10}) const;

  /// Calls `on_change` with how a task stands, and each time that this changes,
  /// on a thread for this watch, until the watch or the node ends: at
  /// once, whatever node of the cell it happens on; where a member could not
  /// ask its coordinator, at most 30 s after it can again.
  task_watch watch(const std::string& task,
                   std::function<void(const task_status&)> on_change) const;

  /// Stops it in order: actor skills get into their safe state and end;
  /// instances that are programs go on, and the next node on the same data
  /// directory finds them. Waits at most `limit` for the end. Returns whether
  /// it has ended. May be called again.
  bool stop(std::chrono::milliseconds limit = std::chrono::seconds{10});

  /// Whether the node has ended, by `stop` or because a part of it has failed.
  bool has_ended() const;

private:
  class impl;
  std::unique_ptr<impl> impl_;
};

} // namespace roscell
