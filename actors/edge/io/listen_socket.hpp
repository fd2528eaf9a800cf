#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <string>

#include <sys/types.h>

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

} // namespace roscell
