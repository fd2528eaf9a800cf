#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/heartbeat_socket.hpp"
#include "actors/edge/session/session_link.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

class site_identity;
struct distrusted;

struct http_server_options {
  std::string address = "127.0.0.1"; ///< IPv4, of this host; empty: no TCP.
  uint16_t port = 8420;              ///< 0: any free one.
  std::string socket_path;           ///< Of the Unix socket; empty: none.
  /// Bearer token that TCP clients must show; if empty, none is let in.
  std::string token;
  /// The first TCP client whose path begins with it and a slash is led to the
  /// path without it, and gets a cookie that counts as a token from then on.
  /// Empty: there is none.
  std::string path_secret;
  /// Hosts that a TCP client may call this server by; empty: any. A page of
  /// another origin whose name leads here is refused by it.
  std::vector<std::string> hosts;
  /// Paths that TCP clients may ask for without a token.
  std::vector<std::string> public_paths{"/healthz"};
  /// Whether a bearer token lets who asks from an address read one path; may be
  /// called by the io thread at any time. Empty: none does.
  std::function<bool(const std::string& path, std::string_view token,
                     const std::string& from)>
      permits;
  http_limits limits;
  http_handler handler;
  /// What this server is at its site. With it TCP speaks TLS 1.3 alone, who
  /// shows no identity of the site gets nothing, and no token counts; null: TCP
  /// is plain.
  std::shared_ptr<site_identity> identity;
  /// Called on the io thread when a handshake has come to nothing, with the
  /// address of the peer. May be empty.
  std::function<void(const std::string& address, const distrusted&)>
      on_distrusted;
};

/// HTTP/1.1 on one TCP port and one Unix socket, with WebSocket sessions at
/// `/v1/session` of the TCP port. It checks who may ask, bounds what may be
/// sent, and hands requests to the handler; it knows no other path. Methods
/// may be called from any thread.
class http_server {
public:
  /// Listens at once. Errors: `conflict` if the port or the socket is in use,
  /// `schema_violation` for an address or path that cannot be, `internal`.
  static edge_result<std::unique_ptr<http_server>>
  start(io_thread& io, http_server_options options);

  /// Closes all connections at once, as the end of the io thread does.
  /// Sessions that passed their handshake belong to their owners and go on.
  virtual ~http_server() = default;

  virtual uint16_t port() const = 0;

  /// From now on, sessions are taken as `acceptor` says; until then they are
  /// refused.
  virtual void accept_sessions(session_acceptor acceptor) = 0;

  /// Stops listening, lets requests in progress end within the grace period,
  /// then calls `on_stopped` on the io thread. The Unix socket's file is gone
  /// when this returns.
  virtual void stop(std::function<void()> on_stopped) = 0;
};

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
