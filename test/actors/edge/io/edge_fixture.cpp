#include "test/actors/edge/io/edge_fixture.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <future>
#include <memory>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace roscell::test::wire {

namespace {

bool wait_for(int fd, short events) {
  pollfd entry{fd, events, 0};
  const auto limit = std::chrono::milliseconds{patience};
  return ::poll(&entry, 1, static_cast<int>(limit.count())) == 1;
}

void echo(const http_request& request, const responder& answer) {
  std::string text = request.method + " " + request.path;
  for (const auto& [key, value] : request.query)
    text += " " + key + "=" + value;
  text += request.local ? " local " : " tcp ";
  answer.reply(200, "text/plain", text + request.body);
}

} // namespace

void settle(io_thread& io) {
  auto done = std::make_shared<std::promise<void>>();
  io.post([done] { done->set_value(); });
  if (done->get_future().wait_for(patience) != std::future_status::ready)
    throw std::runtime_error("the io thread hangs");
}

raw_client::raw_client(uint16_t port, int receive_bytes)
    : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_bytes > 0)
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_bytes,
                 sizeof receive_bytes);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    throw std::runtime_error(std::string{"connect: "} + std::strerror(errno));
}

raw_client::raw_client(const std::string& socket_path)
    : fd_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  socket_path.copy(to.sun_path, sizeof to.sun_path - 1);
  if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    throw std::runtime_error(std::string{"connect: "} + std::strerror(errno));
}

raw_client::~raw_client() {
  close();
}

void raw_client::close() {
  if (fd_ >= 0)
    ::close(std::exchange(fd_, -1));
}

bool raw_client::send(std::string_view text) {
  while (!text.empty()) {
    if (!wait_for(fd_, POLLOUT))
      return false;
    const auto sent =
        ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN)
      return false;
    text.remove_prefix(sent > 0 ? static_cast<size_t>(sent) : 0);
  }
  return true;
}

size_t raw_client::send_some(std::string_view text) {
  const auto sent =
      ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent > 0 ? static_cast<size_t>(sent) : 0;
}

std::string raw_client::read_to_end() {
  return read_until({});
}

std::string raw_client::read_until(std::string_view mark) {
  std::string result;
  std::array<char, 4096> buffer{};
  while (mark.empty() || result.find(mark) == std::string::npos) {
    if (!wait_for(fd_, POLLIN))
      throw std::runtime_error("nothing to read");
    const auto got = ::recv(fd_, buffer.data(), buffer.size(), 0);
    if (got <= 0)
      return result;
    result.append(buffer.data(), static_cast<size_t>(got));
  }
  return result;
}

bool raw_client::is_readable() const {
  pollfd entry{fd_, POLLIN, 0};
  return ::poll(&entry, 1, 0) == 1;
}

bool raw_client::is_closed() {
  char byte = 0;
  const auto got = ::recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN);
}

http_fixture::http_fixture(http_limits limits, bool with_socket) {
  http_server_options options;
  options.port = 0;
  if (with_socket)
    options.socket_path = socket_path();
  options.token = bearer;
  options.limits = limits;
  options.handler = [this](http_request request, responder answer) {
    if (request.path == "/echo" || request.path == "/healthz")
      echo(request, answer);
    else
      requests.put({std::move(request), std::move(answer)});
  };
  server = expect(http_server::start(io, std::move(options)));
}

http_client http_fixture::tcp_client(std::string token) const {
  http_endpoint to;
  to.address = "127.0.0.1";
  to.port = server->port();
  to.token = std::move(token);
  return http_client{to};
}

http_client http_fixture::local_client() const {
  http_endpoint to;
  to.socket_path = socket_path();
  return http_client{to};
}

std::string get(const std::string& path, const std::string& more) {
  return "GET " + path + " HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer "
         + bearer + "\r\n" + more + "\r\n";
}

} // namespace roscell::test::wire
