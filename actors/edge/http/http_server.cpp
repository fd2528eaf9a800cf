#include "actors/edge/http/http_server.hpp"

#include "actors/edge/http/http_connection.hpp"
#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/sockets.hpp"

#include <mutex>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// The server on the io thread.
class server_core : public io_component,
                    public std::enable_shared_from_this<server_core> {
public:
  explicit server_core(std::shared_ptr<http_shared> shared)
      : shared_(std::move(shared)), grace_(shared_->core->context()) {
    // nop
  }

  /// Owns `fd` from now on. Called before `run`.
  void listen(int fd, bool local) {
    listeners_.push_back(std::make_shared<http_listener>(shared_, fd, local));
  }

  void run() {
    shared_->core->adopt(shared_from_this());
    for (const auto& listener : listeners_)
      listener->run();
  }

  void accept_sessions(std::shared_ptr<const session_acceptor> acceptor) {
    shared_->sessions = std::move(acceptor);
  }

  void stop(std::function<void()> on_stopped) {
    if (finished_)
      return shared_->core->guarded(on_stopped);
    close_listeners();
    on_stopped_ = std::move(on_stopped);
    shared_->draining = true;
    shared_->on_idle = [self = shared_from_this()] { self->finish(); };
    grace_.expires_after(shared_->limits.grace);
    grace_.async_wait([self = shared_from_this()](auto ec) {
      if (!ec)
        self->finish();
    });
    for (const auto& connection : shared_->table.all())
      connection->drain();
    if (shared_->table.empty())
      finish();
  }

  void on_io_stop() override {
    finish();
  }

  /// Closes everything at once.
  void finish() {
    if (std::exchange(finished_, true))
      return;
    const auto self = shared_from_this();
    shared_->on_idle = nullptr;
    shared_->sessions = nullptr;
    close_listeners();
    grace_.cancel();
    for (const auto& connection : shared_->table.all())
      connection->abort();
    shared_->handler = nullptr;
    shared_->core->release(this);
    if (on_stopped_)
      shared_->core->guarded(std::exchange(on_stopped_, nullptr));
  }

private:
  void close_listeners() {
    for (const auto& listener : std::exchange(listeners_, {}))
      listener->close();
  }

  std::shared_ptr<http_shared> shared_;
  boost::asio::steady_timer grace_;
  std::vector<std::shared_ptr<http_listener>> listeners_;
  std::function<void()> on_stopped_;
  bool finished_ = false;
};

/// The server for its owner.
class server_handle : public http_server {
public:
  server_handle(std::shared_ptr<http_shared> shared, std::string socket_path,
                const std::optional<bound_port>& tcp,
                const std::optional<listening_unix>& local)
      : io_(shared->core),
        server_(std::make_shared<server_core>(std::move(shared))),
        socket_path_(std::move(socket_path)), local_(local),
        port_(tcp ? tcp->port : 0) {
    if (tcp)
      server_->listen(tcp->fd, false);
    if (local)
      server_->listen(local->fd, true);
    io_->post([server = server_] { server->run(); });
  }

  ~server_handle() override {
    remove_socket();
    io_->post([server = server_] { server->finish(); });
  }

  uint16_t port() const override {
    return port_;
  }

  void accept_sessions(session_acceptor acceptor) override {
    auto shared = std::make_shared<const session_acceptor>(std::move(acceptor));
    io_->post([server = server_, shared = std::move(shared)] {
      server->accept_sessions(shared);
    });
  }

  void stop(std::function<void()> on_stopped) override {
    remove_socket();
    io_->post([server = server_, on_stopped = std::move(on_stopped)] {
      server->stop(on_stopped);
    });
  }

private:
  void remove_socket() {
    const std::lock_guard guard{mutex_};
    if (const auto made = std::exchange(local_, std::nullopt))
      remove_unix_socket(socket_path_, *made);
  }

  std::shared_ptr<io_core> io_;
  std::shared_ptr<server_core> server_;
  std::string socket_path_;
  std::mutex mutex_;
  std::optional<listening_unix> local_; ///< Until its file was removed.
  uint16_t port_;
};

} // namespace

edge_result<std::unique_ptr<http_server>>
http_server::start(io_thread& io, http_server_options options) {
  std::optional<bound_port> tcp;
  if (!options.address.empty()) {
    auto made = listen_on_tcp(options.address, options.port);
    if (auto* why = std::get_if<edge_error>(&made))
      return *why;
    tcp = std::get<bound_port>(made);
  }
  std::optional<listening_unix> local;
  if (!options.socket_path.empty()) {
    auto made = listen_on_unix(options.socket_path);
    if (auto* why = std::get_if<edge_error>(&made)) {
      if (tcp)
        close_listening(tcp->fd);
      return *why;
    }
    local = std::get<listening_unix>(made);
  }
  auto shared = std::make_shared<http_shared>(io.core(), options.limits);
  shared->access = {std::move(options.token), std::move(options.path_secret),
                    std::move(options.hosts), std::move(options.public_paths),
                    std::move(options.permits)};
  if (tcp && !shared->access.path_secret.empty()) {
    constexpr size_t cookie_bytes = 16;
    shared->access.cookie_name += "-" + std::to_string(tcp->port);
    shared->access.cookie_value = to_hex(random_bytes(cookie_bytes));
  }
  shared->handler = std::move(options.handler);
  shared->identity = std::move(options.identity);
  shared->on_distrusted = std::move(options.on_distrusted);
  return std::make_unique<server_handle>(
      std::move(shared), std::move(options.socket_path), tcp, local);
}

namespace {

edge_result<node_sockets> try_once(io_thread& io,
                                   const http_server_options& http,
                                   heartbeat_socket_options heartbeat_options) {
  node_sockets result;
  heartbeat_options.address = http.address;
  heartbeat_options.port = http.port;
  auto heartbeat = heartbeat_socket::open(io, std::move(heartbeat_options));
  if (auto* why = std::get_if<edge_error>(&heartbeat))
    return *why;
  result.heartbeat =
      std::get<std::unique_ptr<heartbeat_socket>>(std::move(heartbeat));
  auto options = http;
  options.port = result.heartbeat->port();
  auto server = http_server::start(io, std::move(options));
  if (auto* why = std::get_if<edge_error>(&server))
    return *why;
  result.http = std::get<std::unique_ptr<http_server>>(std::move(server));
  return result;
}

} // namespace

edge_result<node_sockets>
open_node_sockets(io_thread& io, http_server_options http,
                  heartbeat_socket_options heartbeat) {
  auto result = try_once(io, http, heartbeat);
  for (int i = 1; i < limits::http::port_attempts && http.port == 0; ++i) {
    const auto* why = std::get_if<edge_error>(&result);
    if (why == nullptr || why->code != error_code::conflict)
      break;
    result = try_once(io, http, heartbeat);
  }
  return result;
}

} // namespace roscell
