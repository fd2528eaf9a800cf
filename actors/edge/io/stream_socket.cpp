#include "actors/edge/io/stream_socket.hpp"

#include <array>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace {

/// Options are best effort: a connection without them still works.
void set(stream_socket& socket, int level, int name, int value) {
  ::setsockopt(socket.native_handle(), level, name, &value, sizeof value);
}

/// Who connects or sends finds out what went wrong here.
void open_socket(stream_socket& socket, int family, int protocol) {
  const int fd = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, protocol);
  boost::system::error_code ec;
  if (fd >= 0)
    socket.assign({family, protocol}, fd, ec);
  if (ec)
    ::close(fd);
}

} // namespace

void open_tcp(stream_socket& socket) {
  open_socket(socket, AF_INET, IPPROTO_TCP);
}

void open_unix(stream_socket& socket) {
  open_socket(socket, AF_UNIX, 0);
}

socket_address peer_of(stream_socket& socket) {
  sockaddr_in peer{};
  socklen_t size = sizeof peer;
  auto* address = reinterpret_cast<sockaddr*>(&peer);
  if (::getpeername(socket.native_handle(), address, &size) != 0
      || peer.sin_family != AF_INET)
    return {};
  std::array<char, INET_ADDRSTRLEN> text{};
  ::inet_ntop(AF_INET, &peer.sin_addr, text.data(), text.size());
  return {text.data(), ntohs(peer.sin_port)};
}

/// Names of users are not looked up: that may go to a server and take long.
std::string peer_name(stream_socket& socket) {
  if (const auto address = peer_of(socket); address.port != 0)
    return to_string(address);
  ucred user{};
  socklen_t size = sizeof user;
  if (::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &user,
                   &size)
      != 0)
    return "somebody who has gone";
  return user.uid == 0 ? "root" : "user " + std::to_string(user.uid);
}

void send_at_once(stream_socket& socket) {
  set(socket, IPPROTO_TCP, TCP_NODELAY, 1);
}

void tune_for_session(stream_socket& socket,
                      std::chrono::milliseconds user_timeout) {
  send_at_once(socket);
  set(socket, IPPROTO_TCP, TCP_USER_TIMEOUT,
      static_cast<int>(user_timeout.count()));
}

void keep_alive(stream_socket& socket) {
  set(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set(socket, IPPROTO_TCP, TCP_KEEPIDLE, 30);
  set(socket, IPPROTO_TCP, TCP_KEEPINTVL, 10);
  set(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
}

void close_now(stream_socket& socket) {
  boost::system::error_code ignored;
  socket.close(ignored);
}

} // namespace roscell
