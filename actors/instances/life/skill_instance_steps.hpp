#pragma once

#include "actors/instances/life/skill_instance.hpp"
#include "actors/instances/limits.hpp"
#include "messages/event_kinds.hpp"

#include <caf/send.hpp>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

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

/// Records an event about the instance.
void record_event(skill_instance_pointer self, const event_kind& event);

/// Tells the supervisor how things stand.
void report(skill_instance_pointer self);

/// Enters a state. What was awaited before is dropped.
void set_state(skill_instance_pointer self, instance_state next,
               const std::string& reason);

/// The same, and tells of it.
void enter(skill_instance_pointer self, instance_state next,
           const std::string& reason = {});

/// Sets the deadline of the present state.
void limit(skill_instance_pointer self, std::chrono::milliseconds span);

/// What the store keeps of it: its row, and where the node was, and in which
/// boot of its host, when its program was started.
store_record record_of(const skill_instance_state& st);

/// Writes how things stand. A restarted node finds the program without it,
/// only less of its story, so a failure is no reason to end the program.
void note(skill_instance_pointer self);

// -- skill_instance_secrets.cpp: what it is given that nobody is told ---------

/// Has its secrets laid out, where it has any, and goes on. Where they cannot
/// be, that run has failed.
void with_secrets(skill_instance_pointer self,
                  const std::function<void(const secrets_laid_out&)>& next);

/// Its program has ended, and so have the files that it was given.
void drop_secrets(skill_instance_pointer self);

/// The specification with the values of variables that are secrets, only for
/// the environment of its program: nothing else may have them.
instance_spec with_values(instance_spec spec, const secrets_laid_out& given);

// -- skill_instance_end.cpp: from one run to the next, or to the end ----------

/// The program has ended, or there never was one: it is started again after a
/// pause where its policy says so, or that was the end.
void conclude(skill_instance_pointer self, instance_state last,
              const std::string& reason);

/// Waits for the rest of a pause that an earlier run of the node has begun.
void resume_pause(skill_instance_pointer self);

/// It is not started before the node is back in its cell.
void wait_for_contact(skill_instance_pointer self);

/// It is started again after `pause`; none: once what it waits for has come.
void back_off(skill_instance_pointer self, const std::string& reason,
              std::optional<std::chrono::milliseconds> pause,
              const std::string& waits = {});

/// The pause is over, or what was waited for has come.
void start_again(skill_instance_pointer self);

// -- skill_instance_interruption.cpp: what the host has ended, not its work
// ----

/// Why a program has ended whose shim was told to end it.
constexpr const char* ordered_to_end =
    "it was interrupted: something outside its cell told it to end, as a host "
    "does that shuts down";

/// The same for one that has been found ended; null if it has ended by itself.
const char* interruption_of(const skill_instance_state& st,
                            const container_adopted& found);

/// Whether it was begun before its host was started.
bool is_of_other_boot(const skill_instance_state& st);

/// The program was ended by its host. That is no end of its work: it is started
/// again as its step says, unless it was to go.
void interrupt(skill_instance_pointer self, const std::string& reason);

/// It has ended for such a reason: it waits for what its step says.
void await_start(skill_instance_pointer self, const std::string& reason);

/// Whether it is started as soon as the coordinator wants it to go on.
bool waits_for_contact(const skill_instance_state& st);

// -- skill_instance_leave.cpp: safe before it ends, gone before it is elsewhere

/// Takes it down for good, once it is stop-safe.
void on_stop(skill_instance_pointer self, const stop_instance& request);

/// Goes on with what an earlier run of the node was asked.
void resume_leaving(skill_instance_pointer self);

/// What has been adopted, and is bound to an address that is gone, is told of
/// it and goes on, or is started again, once it is stop-safe. Its policy is not
/// asked, for it has done nothing wrong.
void renew(skill_instance_pointer self);

/// Its skill has told whether it may be ended.
void on_safety(skill_instance_pointer self, safe_word word);

/// The patience with one that is not stop-safe is over.
void on_patience_over(skill_instance_pointer self);

/// Whether it may be started as far as its cell is concerned: not while another
/// node may have it.
bool may_start(skill_instance_pointer self);

/// When its container ends unless that is moved on; 0: never.
int64_t fence_of(const skill_instance_state& st);

/// Whether it was the fence that has ended it.
bool was_fenced(skill_instance_pointer self);

void on_contact(skill_instance_pointer self, const contact_proven& event);
void on_contact_lost(skill_instance_pointer self);

// -- skill_instance_health.cpp ------------------------------------------------

/// Its skill has given a sign of life, and maybe told what it has measured of
/// its streams. What is unhealthy is taken down, so that its policy starts it
/// again.
void follow_health(skill_instance_pointer self, const instance_notified& x);

/// The node's discovery server knows all of its topics but these.
void on_sight(skill_instance_pointer self, const endpoints_missing& x);

/// Nothing that was said of a run that is over counts for the next one.
void forget_health(skill_instance_state& st);

// -- skill_instance_parameters.cpp: other parameters while it runs ------------

/// Has the program work with these, and writes them down once it does. A newer
/// request takes the place of one that is not answered. Errors: see
/// `skill_instance_actor`.
caf::result<parameters_set> take_parameters(skill_instance_pointer self,
                                            const set_parameters& request);

/// What is waited for will not be answered.
void drop_change(skill_instance_pointer self, const std::string& why);

/// Its program has answered, maybe.
void on_change_answered(skill_instance_pointer self,
                        const instance_notified& x);

/// It has not in time.
void on_change_late(skill_instance_pointer self);

/// It is ready, and is told what has changed since it was started.
void pass_on_when_ready(skill_instance_pointer self);

// -- skill_instance_steps.cpp -------------------------------------------------

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

/// Builds and starts; the intent is on disk.
void build(skill_instance_pointer self);

/// Where its cell is now, as far as its programs are concerned.
void on_place(skill_instance_pointer self, const use_environment& place);

/// Records the intent, builds, starts.
void begin_anew(skill_instance_pointer self);

/// Takes over what an earlier run of this node has started, or begins anew.
void adopt(skill_instance_pointer self);

} // namespace roscell
