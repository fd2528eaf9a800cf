#pragma once

#include "test/actors/edge/io/edge_fixture.hpp"

#include <string>
#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell::test::wire {

/// A server that says what a test wants, to one client.
class canned_server {
public:
  explicit canned_server(std::string reply, bool close_after = true)
      : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    ::bind(fd_, generic, size);
    ::listen(fd_, 1);
    ::getsockname(fd_, generic, &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread{[this, reply = std::move(reply), close_after] {
      const int client = ::accept(fd_, nullptr, nullptr);
      std::string request(4096, '\0');
      ::recv(client, request.data(), request.size(), 0);
      ::send(client, reply.data(), reply.size(), MSG_NOSIGNAL);
      if (!close_after) // Until the client goes.
        ::recv(client, request.data(), request.size(), 0);
      ::close(client);
    }};
  }

  canned_server(const canned_server&) = delete;
  canned_server& operator=(const canned_server&) = delete;

  ~canned_server() {
    thread_.join();
    ::close(fd_);
  }

  uint16_t port() const {
    return port_;
  }

private:
  int fd_;
  uint16_t port_ = 0;
  std::thread thread_;
};

} // namespace roscell::test::wire
