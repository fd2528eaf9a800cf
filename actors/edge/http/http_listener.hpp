#pragma once

#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/io/stream_socket.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <memory>

namespace roscell {

/// INTERNAL to this folder: takes connections from one listening socket.
/// Io thread only.
class http_listener : public std::enable_shared_from_this<http_listener> {
public:
  /// Owns `fd`, which does not block. `local` says that it is a Unix socket.
  http_listener(std::shared_ptr<http_shared> shared, int fd, bool local);

  void run();
  void close();

private:
  using error = boost::system::error_code;

  void wait();
  bool accept_one();
  void admit(int fd);
  void rest();

  std::shared_ptr<http_shared> shared_;
  boost::asio::posix::stream_descriptor listening_;
  boost::asio::steady_timer pause_;
  const bool local_;
  bool complained_ = false;
};

} // namespace roscell
