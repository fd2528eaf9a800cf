#pragma once

#include "actors/edge/io/socket_address.hpp"

#include <boost/asio/generic/stream_protocol.hpp>

#include <chrono>
#include <string>

/// INTERNAL to this folder: one type for TCP and Unix sockets, so that the
/// code for connections is compiled once.
namespace roscell {

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
