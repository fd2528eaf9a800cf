#include "actors/edge/http/node_sockets.hpp"

#include "actors/edge/http/limits.hpp"

#include <utility>

namespace roscell {

namespace {

edge_result<node_sockets> try_once(io_thread& io,
                                   const http_server_options& http,
                                   heartbeat_socket_options heartbeat_options) {
  node_sockets result;
  heartbeat_options.address = http.address;
  heartbeat_options.port = http.port;
  auto heartbeat = heartbeat_socket::open(io, std::move(heartbeat_options));
  if (auto* why = std::get_if<edge_error>(&heartbeat))
    return *why;
  result.heartbeat =
      std::get<std::unique_ptr<heartbeat_socket>>(std::move(heartbeat));
  auto options = http;
  options.port = result.heartbeat->port();
  auto server = http_server::start(io, std::move(options));
  if (auto* why = std::get_if<edge_error>(&server))
    return *why;
  result.http = std::get<std::unique_ptr<http_server>>(std::move(server));
  return result;
}

} // namespace

edge_result<node_sockets>
open_node_sockets(io_thread& io, http_server_options http,
                  heartbeat_socket_options heartbeat) {
  auto result = try_once(io, http, heartbeat);
  for (int i = 1; i < limits::http::port_attempts && http.port == 0; ++i) {
    const auto* why = std::get_if<edge_error>(&result);
    if (why == nullptr || why->code != error_code::conflict)
      break;
    result = try_once(io, http, heartbeat);
  }
  return result;
}

} // namespace roscell
