#include "actors/edge/http/node_sockets.hpp"

#include "actors/house/limits.hpp"

#include <utility>

namespace roscell {

namespace {

edge_result<node_sockets> try_once(io_thread& io,
                                   const http_server_options& http,
                                   beat_socket_options beat_options) {
  node_sockets result;
  beat_options.address = http.address;
  beat_options.port = http.port;
  auto beat = beat_socket::open(io, std::move(beat_options));
  if (auto* why = std::get_if<edge_error>(&beat))
    return *why;
  result.beat = std::get<std::unique_ptr<beat_socket>>(std::move(beat));
  auto options = http;
  options.port = result.beat->port();
  auto server = http_server::start(io, std::move(options));
  if (auto* why = std::get_if<edge_error>(&server))
    return *why;
  result.http = std::get<std::unique_ptr<http_server>>(std::move(server));
  return result;
}

} // namespace

edge_result<node_sockets> open_node_sockets(io_thread& io,
                                            http_server_options http,
                                            beat_socket_options beat) {
  auto result = try_once(io, http, beat);
  for (int i = 1; i < limits::http::port_attempts && http.port == 0; ++i) {
    const auto* why = std::get_if<edge_error>(&result);
    if (why == nullptr || why->code != error_code::conflict)
      break;
    result = try_once(io, http, beat);
  }
  return result;
}

} // namespace roscell
