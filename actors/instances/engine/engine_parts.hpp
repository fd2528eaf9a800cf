#pragma once

#include "actors/instances/engine/engine_calls.hpp"

#include <caf/result.hpp>

#include <functional>

/// INTERNAL to the engine runtime: its parts.
namespace roscell {

// Images: engine_images.cpp.
caf::result<image_prepared> prepare(engine_runtime_pointer self,
                                    const prepare_image& request);
void on_build_lines(engine_runtime_pointer self, image_work& work,
                    const std::vector<std::string>& lines);

/// Tells of the steps of builds that were kept back, as far as it is time, and
/// sets the alarm for the others.
void report_build_steps(engine_runtime_pointer self);

// Containers: engine_start.cpp, engine_stop.cpp, engine_adoption.cpp.
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

// Logs of containers that go: engine_kept_logs.cpp.

/// Puts the end of a container's log into the history, if it is wanted there
/// and can be read.
/// @param then called once: when it is there, or cannot be.
void keep_log(engine_runtime_pointer self, const remove_container& request,
              std::function<void()> then);

/// False: it is no such log.
bool take_end_of_log(engine_runtime_pointer self, const engine_log_read& end);

/// Answers the followers whose time is over, and sets the alarm for the others.
void release_followers(engine_runtime_pointer self);

} // namespace roscell
