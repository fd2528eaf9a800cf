#include "actors/edge/http/http_shared.hpp"

#include "actors/edge/http/http_connection.hpp"
#include "actors/edge/http/limits.hpp"

#include <boost/beast/http/status.hpp>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace roscell {

edge_error crowd_error() {
  return {error_code::conflict, "too many clients are connected",
          "ask again in a moment; clients that follow events or logs keep "
          "their places until they end"};
}

connection_table::connection_table(const http_limits& limits)
    : limits_{limits.unauthenticated_peers, limits.joining, limits.trusted,
              limits.local, limits.refused},
      waiting_limit_(limits.waiting) {
  // nop
}

bool connection_table::full(http_group group) {
  return count(group) >= limits_[static_cast<size_t>(group)];
}

bool connection_table::make_room(http_group group) {
  const bool unproven = group == http_group::unauthenticated_peers
                        || group == http_group::joining;
  if (unproven && full(group))
    evict_from(group);
  return !full(group)
         || (group == http_group::local && queue_.size() < waiting_limit_);
}

void connection_table::add(const std::shared_ptr<http_connection>& connection,
                           http_group group) {
  const bool queued = full(group);
  entries_.emplace(connection.get(), entry{connection, group, queued});
  if (queued) {
    queue_.push_back(connection.get());
    return connection->wait_for_turn();
  }
  ++count(group);
  connection->run();
}

bool connection_table::refuse(
    const std::shared_ptr<http_connection>& connection) {
  if (full(http_group::refused))
    return false;
  entries_.emplace(connection.get(),
                   entry{connection, http_group::refused, false});
  ++count(http_group::refused);
  connection->refuse_crowd();
  return true;
}

void connection_table::serve_next() {
  while (!queue_.empty() && !full(http_group::local)) {
    auto& next = entries_.at(queue_.front());
    queue_.pop_front();
    next.queued = false;
    ++count(http_group::local);
    // A copy, since its end would drop the entry.
    const auto connection = next.connection;
    connection->run();
  }
}

bool connection_table::promote(const http_connection* connection,
                               http_group group) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return false;
  if (i->second.group != http_group::unauthenticated_peers)
    return true;
  if (!make_room(group))
    return false;
  --count(i->second.group);
  i->second.group = group;
  ++count(group);
  return true;
}

void connection_table::remove(const http_connection* connection) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return;
  const auto gone = i->second;
  entries_.erase(i);
  if (gone.queued) {
    queue_.erase(std::find(queue_.begin(), queue_.end(), connection));
    return;
  }
  --count(gone.group);
  serve_next();
}

void connection_table::evict_from(http_group group) {
  std::shared_ptr<http_connection> silent;
  for (const auto& [key, entry] : entries_)
    if (entry.group == group
        && (!silent || key->last_heard() < silent->last_heard()))
      silent = entry.connection;
  if (silent)
    silent->abort();
}

std::vector<std::shared_ptr<http_connection>> connection_table::all() const {
  std::vector<std::shared_ptr<http_connection>> result;
  result.reserve(entries_.size());
  for (const auto& [key, entry] : entries_)
    result.push_back(entry.connection);
  return result;
}

namespace {

/// A page loads nothing from elsewhere, makes no code out of text, and is shown
/// inside no other.
constexpr const char* page_rules =
    "\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; "
    "style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'"
    "\r\nX-Content-Type-Options: nosniff"
    "\r\nReferrer-Policy: no-referrer";

class connection_sink : public reply_sink {
public:
  connection_sink(std::shared_ptr<http_shared> shared,
                  std::weak_ptr<http_connection> connection)
      : shared_(std::move(shared)), connection_(std::move(connection)) {
    // nop
  }

  void reply(http_reply reply) override {
    shared_->core->post(
        [connection = connection_, reply = std::move(reply)]() mutable {
          if (const auto alive = connection.lock())
            alive->reply(std::move(reply));
        });
  }

  std::shared_ptr<http_stream> stream(std::string content_type) override {
    auto stream = std::make_shared<stream_connection>(
        shared_->core, shared_->limits, std::move(content_type));
    shared_->core->post([connection = connection_, stream] {
      if (const auto alive = connection.lock())
        alive->hand_over(stream);
      else
        stream->abort();
    });
    return stream_connection::make_handle(std::move(stream));
  }

private:
  std::shared_ptr<http_shared> shared_;
  std::weak_ptr<http_connection> connection_;
};

} // namespace

std::shared_ptr<reply_sink>
make_sink(std::shared_ptr<http_shared> shared,
          std::weak_ptr<http_connection> connection) {
  return std::make_shared<connection_sink>(std::move(shared),
                                           std::move(connection));
}

std::string reply_head(const http_reply& reply, bool is_last,
                       const std::string& more) {
  const auto reason = boost::beast::http::obsolete_reason(
      boost::beast::http::int_to_status(static_cast<unsigned>(reply.status)));
  std::string text = "HTTP/1.1 " + std::to_string(reply.status) + " ";
  text += std::string_view{reason.data(), reason.size()};
  text += "\r\nContent-Type: " + reply.content_type;
  text += "\r\nContent-Length: " + std::to_string(reply.body.size());
  text += "\r\nCache-Control: no-store" + more;
  if (reply.content_type.rfind("text/html", 0) == 0)
    text += page_rules;
  if (reply.status == 401)
    text += "\r\nWWW-Authenticate: Bearer";
  if (reply.status == 405)
    text += "\r\nAllow: GET, POST";
  text += is_last ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  return text + "\r\n\r\n";
}

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
  auto connection = std::make_shared<http_connection>(
      shared_, link_socket{shared_->core, std::move(socket)}, local_);
  if (has_room)
    return shared_->table.add(connection, group);
  // It reads the answer although it has not written its request yet.
  if (!shared_->table.refuse(connection))
    connection->abort();
}

} // namespace roscell
