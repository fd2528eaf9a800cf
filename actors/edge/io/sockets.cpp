#include "actors/edge/io/sockets.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

/// Closes what was opened if a later step fails.
class fd_guard {
public:
  explicit fd_guard(int fd) : fd_(fd) {
    // nop
  }

  fd_guard(const fd_guard&) = delete;
  fd_guard& operator=(const fd_guard&) = delete;

  ~fd_guard() {
    if (fd_ >= 0)
      ::close(fd_);
  }

  int get() const {
    return fd_;
  }

  int release() {
    return std::exchange(fd_, -1);
  }

private:
  int fd_;
};

/// Not inherited by instances that are forked: a peer would take the node for
/// alive after its death.
int open_socket(int family, int type = SOCK_STREAM) {
  return ::socket(family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

template <class Address>
const sockaddr* generic(const Address& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

edge_error failed(const std::string& what, int error) {
  return {error_code::internal,
          what + ": " + std::generic_category().message(error), ""};
}

edge_error bind_error(const std::string& address, uint16_t port, int error) {
  const auto where = address + ":" + std::to_string(port);
  if (error == EADDRINUSE)
    return {error_code::conflict, "port " + where + " is in use",
            "stop the program that uses it, or choose another port"};
  if (error == EADDRNOTAVAIL)
    return {error_code::schema_violation,
            address + " is not an address of this host",
            "choose the address of one of its interfaces"};
  return failed("cannot listen on " + where, error);
}

uint16_t port_of(int fd) {
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size);
  return ntohs(bound.sin_port);
}

/// Makes it listen, too, if it is a socket for streams.
edge_result<bound_port> bind_port(const std::string& address, uint16_t port,
                                  int type) {
  sockaddr_in wanted{};
  wanted.sin_family = AF_INET;
  wanted.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &wanted.sin_addr) != 1)
    return edge_error{error_code::schema_violation,
                      "'" + address + "' is not an IPv4 address", ""};
  fd_guard fd{open_socket(AF_INET, type)};
  if (fd.get() < 0)
    return failed("cannot open a socket", errno);
  const bool streams = type == SOCK_STREAM;
  const int on = 1;
  if (streams) // Else the port of a node that was just killed is still taken.
    ::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(fd.get(), generic(wanted), sizeof wanted) != 0
      || (streams && ::listen(fd.get(), SOMAXCONN) != 0))
    return bind_error(address, port, errno);
  const auto bound = port_of(fd.get());
  return bound_port{fd.release(), bound};
}

std::optional<sockaddr_un> unix_address(const std::string& path) {
  sockaddr_un result{};
  result.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof result.sun_path)
    return std::nullopt;
  std::memcpy(result.sun_path, path.data(), path.size());
  return result;
}

bool somebody_listens(const sockaddr_un& address) {
  const fd_guard probe{open_socket(AF_UNIX)};
  // A full backlog (EAGAIN) is a sign of life, too.
  return ::connect(probe.get(), generic(address), sizeof address) == 0
         || errno == EAGAIN;
}

/// Makes the path free, unless something that counts is there.
std::optional<edge_error> clear_path(const std::string& path,
                                     const sockaddr_un& address) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) != 0)
    return std::nullopt;
  if (!S_ISSOCK(there.st_mode))
    return edge_error{error_code::conflict, path + " is in the way: no socket",
                      "choose another path"};
  if (somebody_listens(address))
    return edge_error{error_code::conflict,
                      "another node runs here: it listens on " + path,
                      "stop it, or choose another data directory"};
  ::unlink(path.c_str());
  return std::nullopt;
}

} // namespace

edge_result<bound_port> listen_on_tcp(const std::string& address,
                                      uint16_t port) {
  return bind_port(address, port, SOCK_STREAM);
}

edge_result<bound_port> bind_udp(const std::string& address, uint16_t port) {
  return bind_port(address, port, SOCK_DGRAM);
}

edge_result<listening_unix> listen_on_unix(const std::string& path) {
  const auto address = unix_address(path);
  if (!address)
    return edge_error{error_code::schema_violation,
                      "'" + path
                          + "' is no path for a socket: it must have 1 "
                            "to 107 bytes",
                      "choose a shorter data directory"};
  if (auto refusal = clear_path(path, *address))
    return *refusal;
  fd_guard fd{open_socket(AF_UNIX)};
  if (fd.get() < 0)
    return failed("cannot open a socket", errno);
  // Nobody can connect before listen(), so the mode is set in time.
  if (::bind(fd.get(), generic(*address), sizeof *address) != 0
      || ::chmod(path.c_str(), 0660) != 0 || ::listen(fd.get(), SOMAXCONN) != 0)
    return failed("cannot listen on " + path, errno);
  struct stat made {};
  ::stat(path.c_str(), &made);
  return listening_unix{fd.release(), made.st_dev, made.st_ino};
}

void close_listening(int fd) {
  ::close(fd);
}

void remove_unix_socket(const std::string& path, const listening_unix& made) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && there.st_dev == made.device
      && there.st_ino == made.inode)
    ::unlink(path.c_str());
}

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
