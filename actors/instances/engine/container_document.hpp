#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/inside/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell {

/// The folder inside a container that holds its NOTIFY_SOCKET.
constexpr const char* container_notify_dir = "/run/roscell";
constexpr const char* notify_socket_name = "notify";

/// What all containers of one node have in common.
struct container_setting {
  std::string node_uuid;  ///< Tells the nodes of one engine apart.
  uint64_t log_bytes = 0; ///< Bound of what the engine keeps of a log.
};

/// A path of the host that a container sees.
struct container_mount {
  std::string source;
  std::string target;
  bool read_only = false;
};

/// What of the host's files a container is to see.
struct container_files {
  std::vector<container_mount> mounts;
  std::vector<std::string> devices;
};

/// The mounts for the endpoints of protocols whose endpoints are paths, and for
/// the deployment's devices and volumes. What is there is mounted itself, input
/// read-only; an input that is not there yet is seen by way of its folder; an
/// output that is not there is made, as the skill itself would. Blocks on the
/// disk. Errors: engine_failed (an output cannot be made).
edge_result<container_files> files_of(const start_container& wish);

/// The name of an instance's container, by which it is found.
std::string container_name(const std::string& instance);

/// The body of POST /containers/create. `notify_dir` is the host's folder with
/// the instance's NOTIFY_SOCKET.
json container_document(const start_container& wish,
                        const container_files& files,
                        const container_setting& setting,
                        const std::string& notify_dir);

} // namespace roscell
