#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A container engine that answers.
struct found_engine {
  std::string socket;
  std::string name;    ///< "docker" or "podman".
  std::string version; ///< "20.10.24"; of Docker only.
  std::string api;     ///< The version of its API to speak; the same.
  /// It runs without root: root in its containers is the user that it runs as.
  bool rootless = false;
};

/// Where an engine's socket may be: of `name` "docker" $DOCKER_HOST,
/// /var/run/docker.sock and the user's own docker.sock; of "podman"
/// $CONTAINER_HOST, the user's own service and the system's; of "auto" all of
/// these in this order. The user's own are in $XDG_RUNTIME_DIR, or in
/// /run/user/UID where that is not set.
std::vector<std::string> engine_sockets(const std::string& name);

/// Asks the engine behind a socket who it is; waits for some ms, and twice for
/// 2 s at most. Errors:
/// unreachable, unauthorized, timeout, engine_failed (something else answers
/// there).
edge_result<found_engine> ask_for_engine(const std::string& socket);

/// The first of the sockets behind which an engine answers. The error is that
/// of the first socket that exists, else of the first.
edge_result<found_engine> find_engine(const std::vector<std::string>& sockets);

} // namespace roscell
