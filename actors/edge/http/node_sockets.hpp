#pragma once

#include "actors/edge/http/http_server.hpp"
#include "actors/edge/session/heartbeat_socket.hpp"

#include <memory>

namespace roscell {

/// The HTTP server and the heartbeat socket of a node, on the same port number.
struct node_sockets {
  std::unique_ptr<http_server> http;
  std::unique_ptr<heartbeat_socket> heartbeat;
};

/// Opens both, on the address and port of `http`. If that port is 0, one is
/// found that is free for both. The heartbeat socket's address and port are of
/// no interest. Errors: those of the two classes.
edge_result<node_sockets>
open_node_sockets(io_thread& io, http_server_options http,
                  heartbeat_socket_options heartbeat = {});

} // namespace roscell
