#pragma once

#include "actors/edge/http/http_server.hpp"
#include "actors/edge/session/beat_socket.hpp"

#include <memory>

namespace roscell {

/// The HTTP server and the beat socket of a node, on the same port number.
struct node_sockets {
  std::unique_ptr<http_server> http;
  std::unique_ptr<beat_socket> beat;
};

/// Opens both, on the address and port of `http`. If that port is 0, one is
/// found that is free for both. The beat socket's address and port are of no
/// interest. Errors: those of the two classes.
edge_result<node_sockets> open_node_sockets(io_thread& io,
                                            http_server_options http,
                                            beat_socket_options beat = {});

} // namespace roscell
