#pragma once

#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/instances/engine/engine_runtime.hpp"

#include <caf/error.hpp>
#include <caf/result.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

/// INTERNAL to the engine runtime: all functions by which its files call each
/// other, grouped by the file that has them. They own nothing: containers,
/// images and calls are in `engine_runtime_state`. What the engine refuses, or
/// does not answer, becomes `engine_failed` (`engine_failure`).
namespace roscell {

using engine_runtime_pointer =
    engine_runtime_actor::stateful_pointer<engine_runtime_state>;

/// Asks the engine; the answer comes as a message to this actor, which calls
/// `then`.
void ask_engine(engine_runtime_pointer self, engine_request what,
                engine_runtime_state::continuation then);

/// Asks for a streamed answer, whose lines come as `engine_streamed`; `then`
/// is called at its end.
struct opened_call {
  uint64_t call = 0;
  engine_stream stream;
};
opened_call stream_lines(engine_runtime_pointer self, engine_request what,
                         engine_runtime_state::continuation then);

/// Registers what happens at the end of a call.
uint64_t expect_answer(engine_runtime_pointer self,
                       engine_runtime_state::continuation then);

/// The message for an answer, made on the io thread.
engine_answered to_message(uint64_t call, engine_answer answer);

/// Whether the engine could not be asked at all, so that nothing is known.
bool is_lost(const engine_answered& x);

bool is_good(const engine_answered& x);

/// What went wrong, as a sentence that begins with `what`: engine_failed.
caf::error engine_failure(const std::string& what, const engine_answered& x);

/// The JSON object of a good answer; an empty object if it is none.
json object_of(const engine_answered& x);

// Images: engine_images.cpp.
caf::result<image_prepared> prepare(engine_runtime_pointer self,
                                    const prepare_image& request);
void on_build_lines(engine_runtime_pointer self, image_work& work,
                    const std::vector<std::string>& lines);

/// Tells of the steps of builds that were kept back, as far as it is time, and
/// sets the alarm for the others.
void report_build_steps(engine_runtime_pointer self);

/// Null: it is over.
image_work* find_work(engine_runtime_pointer self, const std::string& key);

/// The work is over, one way or the other.
void conclude_work(engine_runtime_pointer self, const std::string& key,
                   const image_prepared& result);
void fail_work(engine_runtime_pointer self, const std::string& key,
               const caf::error& why);

/// How an image that cannot be built is told, with the end of the log.
caf::error build_failure(const engine_runtime_state& st, const image_work& work,
                         const std::string& why, const std::string& hint);

/// A request to the packer whose answer is dropped when the work is over.
template <class Reply, class Request, class F>
void ask_packer(engine_runtime_pointer self, const std::string& key,
                std::chrono::milliseconds limit, const Request& what,
                F on_reply) {
  self->request(find_work(self, key)->packer, limit, what)
      .then(
          [=](const Reply& x) {
            if (auto* work = find_work(self, key))
              on_reply(*work, x);
          },
          [=](const caf::error& error) { fail_work(self, key, error); });
}

// Base images: engine_base.cpp.

/// Has the engine know the base image, from another node or its registry; then
/// calls `then`, if the work is still to be done.
void find_base(engine_runtime_pointer self, const std::string& key,
               std::function<void()> then);

/// Ends the pulls whose registries say nothing, and sets the alarm for others.
void end_silent_pulls(engine_runtime_pointer self);

// Images that are not used any more: engine_cleaning.cpp.

/// Removes those that are beyond the bound. What cannot be removed stays.
void clean_images(engine_runtime_pointer self);

// Containers: engine_start.cpp, engine_stop.cpp, engine_parts.cpp.
caf::result<container_started> start(engine_runtime_pointer self,
                                     const start_container& request);
caf::result<container_stopped> stop(engine_runtime_pointer self,
                                    const stop_container& request);
caf::result<container_removed> remove(engine_runtime_pointer self,
                                      const remove_container& request);
caf::result<container_adopted> adopt(engine_runtime_pointer self,
                                     const adopt_container& request);

/// Ends by force what belongs to the instance, and asks nobody.
void discard(engine_runtime_pointer self, const std::string& instance);

// The stream of events: engine_watch.cpp.
void watch_events(engine_runtime_pointer self);
void on_event_lines(engine_runtime_pointer self,
                    const std::vector<std::string>& lines);

// Logs: engine_logs.cpp.
caf::result<log_excerpt> read_log(engine_runtime_pointer self,
                                  const log_query& query);
void on_log_read(engine_runtime_pointer self, const engine_log_read& part);

// Logs of containers that go: engine_logs.cpp.

/// Puts the end of a container's log into the history, if it is wanted there
/// and can be read.
/// @param then called once: when it is there, or cannot be.
void keep_log(engine_runtime_pointer self, const remove_container& request,
              std::function<void()> then);

/// False: it is no such log.
bool take_end_of_log(engine_runtime_pointer self, const engine_log_read& end);

/// Answers the followers whose time is over, and sets the alarm for the others.
void release_followers(engine_runtime_pointer self);

// Containers that are known: engine_containers.cpp.

caf::error bad_id(const std::string& instance);

/// Null if none is known.
engine_container* find_container(engine_runtime_pointer self,
                                 const std::string& instance);

/// The host's folder with the instance's NOTIFY_SOCKET, see
/// container_notify_path.
std::filesystem::path notify_dir(engine_runtime_pointer self,
                                 const std::string& instance);

/// The host's file with the instance's fence.
std::filesystem::path fence_file(engine_runtime_pointer self,
                                 const std::string& instance);

/// The host's file in which the instance's shim writes how it has ended.
std::filesystem::path exit_file(engine_runtime_pointer self,
                                const std::string& instance);

/// The host's copy of the shim, for containers.
std::filesystem::path shim_file(engine_runtime_pointer self);

/// Makes the NOTIFY_SOCKET and listens to it. Errors: engine_failed.
caf::error open_status(engine_runtime_pointer self, const std::string& instance,
                       engine_container& x);

/// Has the listener told what waits at its NOTIFY_SOCKET.
void hear(engine_runtime_pointer self, const std::string& instance);

/// It runs, and everybody may know.
void settle(engine_runtime_pointer self, const std::string& instance,
            const std::string& id);

/// Forgets it; whatever waited goes on.
void forget(engine_runtime_pointer self, const std::string& instance);

/// Removes what the host has of it.
void clean_up(engine_runtime_pointer self, const std::string& instance);

/// The container of an instance has ended: tells it, once.
void on_container_ended(engine_runtime_pointer self,
                        const std::string& instance, const std::string& id,
                        int exit_code);

engine_request
to_container(std::string method, const std::string& container,
             const std::string& what,
             std::chrono::milliseconds limit = limits::engine::call);

/// What a request means: its container, or the present one of the instance.
std::string target_of(const std::string& container,
                      const std::string& instance);

/// Of an inspected container. The exit code is negative if it is not known.
int exit_code_of(const json& container);
bool is_running(const json& container);

/// What has ended a container besides its exit code: what its engine says, and
/// what its shim has written down.
end_cause cause_of(const json& container,
                   const std::optional<recorded_end>& end, int exit_code);

} // namespace roscell
