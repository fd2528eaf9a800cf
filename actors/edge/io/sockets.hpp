#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/socket_address.hpp"

#include <boost/asio/generic/stream_protocol.hpp>

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <string>

namespace roscell {

/// A socket that is bound to a port. Its taker closes it.
struct bound_port {
  int fd = -1;
  uint16_t port = 0; ///< The one that the system chose if 0 was asked for.
};

/// Listens on a dotted IPv4 address of this host. Errors: `conflict` if the
/// port is in use, `schema_violation` for a bad address, `internal`.
edge_result<bound_port> listen_on_tcp(const std::string& address,
                                      uint16_t port);

/// The same for a UDP socket.
edge_result<bound_port> bind_udp(const std::string& address, uint16_t port);

/// A Unix socket that listens, and the identity of its file.
struct listening_unix {
  int fd = -1;
  dev_t device = 0;
  ino_t inode = 0;
};

/// Listens on a Unix socket with mode 0660. A file that a dead process left
/// is replaced. Errors: `conflict` if a live process listens there or the
/// file is no socket, `schema_violation` if the path is too long for a
/// socket, `internal`.
edge_result<listening_unix> listen_on_unix(const std::string& path);

/// Closes a socket that nobody took.
void close_listening(int fd);

/// Removes the socket's file, if it is still the one that was made.
void remove_unix_socket(const std::string& path, const listening_unix& made);

// INTERNAL to this folder: one type for TCP and Unix sockets, so that the
// code for connections is compiled once.

using stream_socket = boost::asio::generic::stream_protocol::socket;

/// Opens a TCP socket that forked instances do not inherit.
void open_tcp(stream_socket& socket);

/// The same for a Unix socket.
void open_unix(stream_socket& socket);

/// The other end of a connected socket; empty if it is gone already or is a
/// Unix socket.
socket_address peer_of(stream_socket& socket);

/// Who is at the other end, for people to read: of a Unix socket the user, whom
/// the kernel has told, else the address.
std::string peer_name(stream_socket& socket);

/// For a TCP socket: does not hold small writes back.
void send_at_once(stream_socket& socket);

/// For a TCP socket: sends small frames at once, and gives the connection up
/// when bytes stay unacknowledged for `user_timeout`.
void tune_for_session(stream_socket& socket,
                      std::chrono::milliseconds user_timeout);

/// Lets the kernel ask a silent peer, after half a minute, whether it is
/// still there. For connections that only send and may have nothing to say.
void keep_alive(stream_socket& socket);

/// Closes without waiting for anything and without an error.
void close_now(stream_socket& socket);

} // namespace roscell
