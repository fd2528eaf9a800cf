#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/codec/json_codec.hpp"
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

// What a container may, and who runs in it: nothing of root's power but what
// its skill is granted, and nothing more by whatever it runs.

/// Writes that into the document's HostConfig.
void bound_powers(json& host, const start_container& request, bool rootless);

/// The user of its first process, the shim: the node's, inside as outside, for
/// files and shared memory belong to him; root of a rootless engine is him. An
/// engine gives capabilities to root alone, so that a shim which hands some on
/// is root, and makes the skill what it is.
std::string container_user(const start_container& request, bool rootless);

/// What tells the shim who the skill is to be.
std::vector<std::string> identity_options(const start_container& request,
                                          bool rootless);

} // namespace roscell
