#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/frame.hpp"

#include <caf/replies_to.hpp>
#include <caf/type_id.hpp>
#include <caf/typed_actor.hpp>
#include <caf/typed_event_based_actor.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

/// Skills whose instances are actors of the program that embeds a node: placed
/// by the scheduler like any other, started in well under a millisecond. They
/// are trusted code: an exception is contained, a crash is the program's.
namespace roscell {

/// One frame for an instance. The next one comes when the handler has returned,
/// so whoever is slow has old frames dropped before they reach it.
struct skill_frame {
  /// Shared with the other steps that read it, never null.
  std::shared_ptr<const engine::frame> data;
  std::size_t port = 0;       ///< Input that it came by, from 0.
  std::uint64_t sequence = 0; ///< Counts the frames of that input from 0.
};

/// A sign of life is wanted. To have handled it is the sign: an instance that
/// handles nothing for 10 s is taken for one that hangs and asked to stop.
struct check_life {};

/// The instance is to bring what it moves into a safe state. When the handler
/// has returned it is ended; in any case after the 5 s that a stop may take.
struct stop_skill {};

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, check_life&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, stop_skill&) {
  return f();
}

/// An instance. It may handle more messages than these, of its own program.
using actor_skill_instance =
    caf::typed_actor<caf::reacts_to<skill_frame>, caf::reacts_to<check_life>,
                     caf::reacts_to<stop_skill>>;

/// What an instance knows and can do. Copies are of the same instance. Every
/// function may be called from any thread, and none throws unless it says so.
class actor_skill_context {
public:
  class impl;
  explicit actor_skill_context(std::shared_ptr<impl> x);

  /// The step, its streams and parameters; never changes.
  const engine::environment& environment() const;

  /// The instance can do its work. Frames come from now on. Without it the
  /// instance is given up after 30 s.
  void ready() const;

  /// Says whether the instance may be ended now, without harm to what it moves;
  /// as engine::executor::set_safe does, with the same bounds.
  void set_safe(bool safe) const;

  /// From now on `call` is called each time that somebody waits for the
  /// instance to be stop-safe. It runs on a thread of the node and must not
  /// block: let it send the instance a message. To be told before `ready`; a
  /// later one replaces it.
  void on_safety_wanted(std::function<void()> call) const;

  /// One line of the instance's log.
  void log(const std::string& line) const;

  /// Gives a frame to whoever reads output `port`, counted from 0: over ROS 2,
  /// or without a copy to steps of this process (protocol "actor"). Empty
  /// fields are filled in: the output's data type, the present time. Throws
  /// std::out_of_range when the step has no such output, engine::stream_error
  /// when it is broken.
  void emit(engine::frame result, std::size_t port = 0) const;
  void emit(std::shared_ptr<const engine::frame> result,
            std::size_t port = 0) const;

private:
  std::shared_ptr<impl> impl_;
};

/// Makes the behavior of a new instance, on a worker that belongs to actor
/// skills alone. It must not block. What it throws ends the instance, with the
/// text in its log.
using actor_skill_factory = std::function<actor_skill_instance::behavior_type(
    actor_skill_instance::pointer self, actor_skill_context context)>;

/// An operation that the program offers to the cells its node joins.
struct actor_skill {
  /// JSON or YAML, as a skill folder's descriptor, with "engine": "actor" and
  /// neither entry point nor base images. Protocols are "ros2", "file" and
  /// "actor"; the endpoint of the last is any name.
  std::string descriptor;
  actor_skill_factory make;
};

} // namespace roscell

CAF_BEGIN_TYPE_ID_BLOCK(roscell_skill, caf::first_custom_type_id + 1000)
  CAF_ADD_TYPE_ID(roscell_skill, (roscell::skill_frame))
  CAF_ADD_TYPE_ID(roscell_skill, (roscell::check_life))
  CAF_ADD_TYPE_ID(roscell_skill, (roscell::stop_skill))
CAF_END_TYPE_ID_BLOCK(roscell_skill)

CAF_ALLOW_UNSAFE_MESSAGE_TYPE(roscell::skill_frame)
