#pragma once

#include "actors/instances/engine/container_access.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/inside/runtime.hpp"

#include <cstdint>
#include <string>

namespace roscell {

/// The folder inside a container that holds its NOTIFY_SOCKET.
constexpr const char* container_notify_dir = "/run/roscell";

/// Where a container has what supervises it.
constexpr const char* shim_inside = "/opt/roscell/instance-shim";
constexpr const char* notify_socket_name = "notify";

/// What all containers of one node have in common.
struct container_setting {
  std::string node_uuid;         ///< Tells the nodes of one engine apart.
  uint64_t log_bytes = 0;        ///< Bound of what the engine keeps of a log.
  std::string engine = "docker"; ///< Or "podman".
  /// Root in a container is the user that the engine runs as.
  bool rootless = false;
};

/// What supervises a container from within, on the host.
struct container_shim {
  std::string program;   ///< Becomes its first process.
  std::string exit_file; ///< Where that writes how the container has ended.
  std::string fence;     ///< actors/edge/process/fence_file.hpp
};

/// The name of an instance's container, by which it is found.
std::string container_name(const std::string& instance);

/// The body of POST /containers/create. `notify_dir` is the host's folder with
/// the instance's NOTIFY_SOCKET; a fence counts where the request has one.
json container_document(const start_container& request,
                        const container_files& files,
                        const container_setting& setting,
                        const std::string& notify_dir,
                        const container_shim& shim);

/// The body of Podman's own POST /libpod/containers/create for the container
/// that `container_document` describes to Docker: Podman drops the GPU requests
/// of Docker's API without a word. GPUs are CDI devices, "nvidia.com/gpu=0".
json podman_document(const std::string& name, const json& docker);

} // namespace roscell
