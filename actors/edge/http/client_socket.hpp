#pragma once

#include "actors/edge/http/http_client.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include <sys/socket.h>

namespace roscell {

/// INTERNAL to this folder: a connection on which a thread waits, with a time
/// limit and a way to be cancelled.
class client_socket {
public:
  using clock = std::chrono::steady_clock;

  client_socket(clock::time_point deadline, const http_cancel* cancel);
  ~client_socket();

  client_socket(const client_socket&) = delete;
  client_socket& operator=(const client_socket&) = delete;

  std::optional<edge_error> connect(const http_endpoint& to);

  /// Sends `text`, but stops without an error when the peer answers before
  /// it has all, or reads no more: its reply says why.
  std::optional<edge_error> send(std::string_view text);

  /// Reads some bytes into `buffer`; empty at the end of the connection.
  edge_result<std::string_view> receive(char* buffer, size_t size);

  /// From now on there is no time limit.
  void wait_forever() {
    deadline_.reset();
  }

private:
  std::optional<edge_error> connect_to(const sockaddr* address, unsigned size,
                                       const std::string& name);
  std::optional<edge_error> connect_tcp(const http_endpoint& to);
  std::optional<edge_error> connect_unix(const std::string& path);

  /// Waits for `events` of the socket.
  std::optional<edge_error> wait(short events, short& happened);
  int time_left_ms() const;

  int fd_ = -1;
  std::optional<clock::time_point> deadline_;
  const http_cancel* cancel_;
};

} // namespace roscell
