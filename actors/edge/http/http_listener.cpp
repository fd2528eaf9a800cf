#include "actors/edge/http/http_listener.hpp"

#include "actors/edge/http/http_connection.hpp"
#include "actors/edge/http/limits.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace {

/// Connections taken in a row before other handlers get their turn.
constexpr int burst = 16;

boost::asio::generic::stream_protocol protocol(bool local) {
  return local ? boost::asio::generic::stream_protocol{AF_UNIX, 0}
               : boost::asio::generic::stream_protocol{AF_INET, IPPROTO_TCP};
}

} // namespace

http_listener::http_listener(std::shared_ptr<http_shared> shared, int fd,
                             bool local)
    : shared_(std::move(shared)), listening_(shared_->core->context(), fd),
      pause_(shared_->core->context()), local_(local) {
  // nop
}

void http_listener::run() {
  wait();
}

void http_listener::close() {
  error ignored;
  listening_.close(ignored);
  pause_.cancel();
}

void http_listener::wait() {
  listening_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                        [self = shared_from_this()](error ec) {
                          if (ec || !self->listening_.is_open())
                            return;
                          for (int i = 0; i < burst; ++i)
                            if (!self->accept_one())
                              return;
                          self->wait();
                        });
}

/// False if it will be tried again later, or never.
bool http_listener::accept_one() {
  // accept4, because an instance that is forked must not inherit the socket:
  // its peer would take the node for alive after its death.
  const int fd = ::accept4(listening_.native_handle(), nullptr, nullptr,
                           SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd >= 0) {
    complained_ = false;
    admit(fd);
    return true;
  }
  if (errno == EAGAIN) {
    wait();
    return false;
  }
  // The client gave up before it was taken.
  if (errno == ECONNABORTED || errno == EINTR)
    return true;
  rest();
  return false;
}

/// Trying again at once would spin until descriptors are freed.
void http_listener::rest() {
  const int why = errno;
  if (!std::exchange(complained_, true))
    shared_->core->log("cannot take connections: "
                       + std::generic_category().message(why));
  shared_->table.evict_from(http_group::unauthenticated_peers);
  pause_.expires_after(limits::http::shortage_pause);
  pause_.async_wait([self = shared_from_this()](error ec) {
    if (!ec && self->listening_.is_open())
      self->wait();
  });
}

void http_listener::admit(int fd) {
  const auto group =
      local_ ? http_group::local : http_group::unauthenticated_peers;
  const bool has_room = shared_->table.make_room(group);
  error ec;
  stream_socket socket{shared_->core->context()};
  socket.assign(protocol(local_), fd, ec);
  if (ec) {
    ::close(fd);
    return;
  }
  if (!local_)
    send_at_once(socket);
  auto connection =
      std::make_shared<http_connection>(shared_, std::move(socket), local_);
  if (has_room)
    return shared_->table.add(connection, group);
  // It reads the answer although it has not written its request yet.
  if (!shared_->table.refuse(connection))
    connection->abort();
}

} // namespace roscell
