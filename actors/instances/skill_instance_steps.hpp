#pragma once

#include "actors/house/limits.hpp"
#include "actors/instances/skill_instance.hpp"

#include <caf/send.hpp>

#include <chrono>
#include <string>

/// INTERNAL to the skill instance: its transitions, as docs/protocols.md draws
/// them, and the two ways in which it begins.
namespace roscell {

using skill_instance_pointer =
    skill_instance_actor::stateful_pointer<skill_instance_state>;

/// A request whose answer is dropped once the instance has moved on.
template <class Reply, class Handle, class Request, class F, class G>
void ask(skill_instance_pointer self, const Handle& whom,
         std::chrono::milliseconds limit, const Request& what, F on_reply,
         G on_error) {
  const auto phase = self->state.phase;
  self->request(whom, limit, what)
      .then(
          [=](const Reply& x) {
            if (self->state.phase == phase)
              on_reply(x);
          },
          [=](const caf::error& x) {
            if (self->state.phase == phase)
              on_error(x);
          });
}

/// An error in a sentence, with its remedy.
std::string sentence(const caf::error& error);

/// The end of a build's log, which goes along with its failure.
std::string log_tail_of(const caf::error& error);

/// Records a fact about the instance.
void record_event(skill_instance_pointer self, const char* fact);

/// Tells the supervisor how things stand.
void report(skill_instance_pointer self);

/// Enters a state and tells of it. What was awaited before is dropped.
void enter(skill_instance_pointer self, instance_state next,
           const std::string& reason = {});

/// Sets the deadline of the present state.
void limit(skill_instance_pointer self, std::chrono::milliseconds span);

/// What the store keeps of it.
store_record record_of(const instance_row& row);

/// The program has ended, or there never was one.
void conclude(skill_instance_pointer self, instance_state last,
              const std::string& reason);

/// Ends the program, then the instance, which will be `last`.
void take_down(skill_instance_pointer self, instance_state last,
               const std::string& reason,
               std::chrono::milliseconds grace = limits::instance::stop_grace);

/// From here on it has to say in time that it is ready; a stock ROS 2 program
/// says so by its endpoints.
void expect_ready(skill_instance_pointer self);

/// From here on it has to give signs of life; of a stock ROS 2 program only its
/// end, and that of its endpoints, is a sign.
void expect_life(skill_instance_pointer self);

/// The program has said that it is ready.
void on_running(skill_instance_pointer self);

/// The runtime has started the program.
void on_started(skill_instance_pointer self, const std::string& container);

/// Records the intent, builds, starts.
void begin_anew(skill_instance_pointer self);

/// Takes over what an earlier run of this node has started, or begins anew.
void adopt(skill_instance_pointer self);

} // namespace roscell
