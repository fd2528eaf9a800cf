#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A container engine that answers.
struct found_engine {
  std::string socket;
  std::string name;    ///< "docker" or "podman".
  std::string version; ///< "20.10.24".
};

/// Where an engine's socket may be: of `name` "docker" $DOCKER_HOST and
/// /var/run/docker.sock, of "podman" the user's own and the system's service,
/// of "auto" all of these in this order.
std::vector<std::string> engine_sockets(const std::string& name);

/// Asks the engine behind a socket for its version; waits for some ms, and for
/// 2 s at most. Errors: unreachable, unauthorized, timeout, engine_failed
/// (something else answers there).
edge_result<found_engine> ask_for_engine(const std::string& socket);

/// The first of the sockets behind which an engine answers. The error is that
/// of the first socket that exists, else of the first.
edge_result<found_engine> find_engine(const std::vector<std::string>& sockets);

} // namespace roscell
