#include "actors/edge/http/client_socket.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace roscell {

namespace {

edge_error unreachable(const std::string& name, const std::string& why) {
  return {error_code::unreachable, "cannot reach " + name + ": " + why,
          "is the node running?"};
}

std::string text_of(int error) {
  return std::generic_category().message(error);
}

void set(int fd, int level, int name, int value) {
  ::setsockopt(fd, level, name, &value, sizeof value);
}

using address_list = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

} // namespace

client_socket::client_socket(clock::time_point deadline,
                             const http_cancel* cancel)
    : deadline_(deadline), cancel_(cancel) {
  // nop
}

client_socket::~client_socket() {
  if (fd_ >= 0)
    ::close(fd_);
}

int client_socket::time_left_ms() const {
  if (!deadline_)
    return -1;
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(*deadline_ - clock::now());
  return static_cast<int>(
      std::clamp<int64_t>(left.count(), 0, std::numeric_limits<int>::max()));
}

std::optional<edge_error> client_socket::wait(short events, short& happened) {
  std::array<pollfd, 2> fds{
      {{fd_, events, 0}, {cancel_ != nullptr ? cancel_->fd() : -1, POLLIN, 0}}};
  int count = 0;
  do
    count = ::poll(fds.data(), fds.size(), time_left_ms());
  while (count < 0 && errno == EINTR);
  if (count == 0)
    return edge_error{error_code::timeout, "no answer within the time limit",
                      ""};
  if (fds[1].revents != 0)
    return edge_error{error_code::conflict, "cancelled", ""};
  happened = fds[0].revents;
  return std::nullopt;
}

std::optional<edge_error> client_socket::connect(const http_endpoint& to) {
  return to.socket_path.empty() ? connect_tcp(to)
                                : connect_unix(to.socket_path);
}

std::optional<edge_error> client_socket::connect_tcp(const http_endpoint& to) {
  const auto name = to.address + ":" + std::to_string(to.port);
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(
      to.address.c_str(), std::to_string(to.port).c_str(), &hints, &found);
  if (error != 0)
    return unreachable(name, ::gai_strerror(error));
  const address_list list{found, &::freeaddrinfo};
  auto failure = connect_to(list->ai_addr, list->ai_addrlen, name);
  if (!failure) {
    set(fd_, IPPROTO_TCP, TCP_NODELAY, 1);
    // A stream may be silent for hours; the host behind it may be gone.
    set(fd_, SOL_SOCKET, SO_KEEPALIVE, 1);
    set(fd_, IPPROTO_TCP, TCP_KEEPIDLE, 30);
    set(fd_, IPPROTO_TCP, TCP_KEEPINTVL, 10);
    set(fd_, IPPROTO_TCP, TCP_KEEPCNT, 3);
  }
  return failure;
}

std::optional<edge_error> client_socket::connect_unix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    return unreachable(path, "the path is too long for a socket");
  std::memcpy(address.sun_path, path.data(), path.size());
  return connect_to(reinterpret_cast<const sockaddr*>(&address), sizeof address,
                    path);
}

std::optional<edge_error> client_socket::connect_to(const sockaddr* address,
                                                    unsigned size,
                                                    const std::string& name) {
  fd_ = ::socket(address->sa_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK,
                 0);
  if (fd_ < 0)
    return unreachable(name, text_of(errno));
  if (::connect(fd_, address, size) == 0)
    return std::nullopt;
  if (errno != EINPROGRESS)
    return unreachable(name, text_of(errno));
  short happened = 0;
  if (auto failure = wait(POLLOUT, happened))
    return failure;
  int error = 0;
  socklen_t error_size = sizeof error;
  ::getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &error_size);
  if (error != 0)
    return unreachable(name, text_of(error));
  return std::nullopt;
}

std::optional<edge_error> client_socket::send(std::string_view text) {
  while (!text.empty()) {
    short happened = 0;
    if (auto failure = wait(POLLIN | POLLOUT, happened))
      return failure;
    if ((happened & POLLIN) != 0)
      return std::nullopt;
    const auto sent = ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EAGAIN && errno != EINTR)
      return std::nullopt;
    text.remove_prefix(sent > 0 ? static_cast<size_t>(sent) : 0);
  }
  return std::nullopt;
}

edge_result<std::string_view> client_socket::receive(char* buffer,
                                                     size_t size) {
  while (true) {
    short happened = 0;
    if (auto failure = wait(POLLIN, happened))
      return *failure;
    const auto got = ::recv(fd_, buffer, size, 0);
    if (got >= 0)
      return std::string_view{buffer, static_cast<size_t>(got)};
    if (errno != EAGAIN && errno != EINTR)
      return edge_error{error_code::unreachable,
                        "the connection broke: " + text_of(errno), ""};
  }
}

} // namespace roscell
