#pragma once

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/instances/engine/engine_calls.hpp"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

/// INTERNAL to the engine runtime: what it knows of its containers.
namespace roscell {

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
