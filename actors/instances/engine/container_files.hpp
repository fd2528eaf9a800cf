#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/inside/runtime.hpp"

#include <string>
#include <vector>

namespace roscell {

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
edge_result<container_files> files_of(const start_container& request);

} // namespace roscell
