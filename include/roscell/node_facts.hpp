#pragma once

#include <string>

namespace roscell {

/// What is known of a node that has started; never changes.
struct node_facts {
  std::string name;
  std::string http_address;     ///< "ip:port" that was really bound.
  std::string socket;           ///< Path of the Unix socket.
  std::string discovery_server; ///< "ip:port"; coordinators only.
  std::string token_file;       ///< Bearer token for HTTP over TCP.
  std::string site_token_file;  ///< Where its site token is, or will be.
  std::string runtime;          ///< "process", "docker" or "podman".
  std::string runtime_reason;   ///< Why this one, one sentence.
  std::string limits; ///< What holds instances to their limits, or why none.
};

} // namespace roscell
