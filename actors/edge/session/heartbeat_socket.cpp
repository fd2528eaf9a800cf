#include "actors/edge/session/heartbeat_socket.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <atomic>
#include <cerrno>
#include <optional>
#include <unordered_map>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace roscell {

namespace {

using error = boost::system::error_code;

/// Packets taken in a row before other handlers get their turn.
constexpr int burst = 64;

std::optional<sockaddr_in> place_of(const std::string& address, uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (port == 0 || ::inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1)
    return std::nullopt;
  return result;
}

/// What the socket knows of one session. Io thread only.
struct heartbeat_session {
  explicit heartbeat_session(heartbeat_registration r)
      : registration(std::move(r)),
        tag(heartbeat_tag(registration.agreement.session)),
        place(place_of(registration.address, registration.port)),
        learns_place(!place) {
    // nop
  }

  bool is_newer(const heartbeat_packet& packet) const {
    return packet.sequence > newest[index(packet.kind)];
  }

  void remember(const heartbeat_packet& packet, const sockaddr_in& from) {
    newest[index(packet.kind)] = packet.sequence;
    if (learns_place)
      place = from;
  }

  static size_t index(heartbeat_kind kind) {
    return static_cast<size_t>(kind);
  }

  heartbeat_registration registration;
  const uint32_t tag;
  std::optional<sockaddr_in> place;
  const bool learns_place;
  std::array<int64_t, 3> newest{-1, -1, -1};
};

/// The socket on the io thread.
class heartbeat_core : public io_component,
                       public std::enable_shared_from_this<heartbeat_core> {
public:
  heartbeat_core(std::shared_ptr<io_core> core, int fd, heartbeat_filter filter,
                 site_secret site)
      : core_(std::move(core)), socket_(core_->context(), fd),
        filter_(std::move(filter)), site_(std::move(site)) {
    // nop
  }

  const std::shared_ptr<io_core>& core() const {
    return core_;
  }

  void run() {
    core_->adopt(shared_from_this());
    wait();
  }

  void on_io_stop() override {
    close();
  }

  void close() {
    if (!socket_.is_open())
      return;
    const auto self = shared_from_this();
    error ignored;
    socket_.close(ignored);
    sessions_.clear();
    core_->release(this);
  }

  void add(std::shared_ptr<heartbeat_session> session) {
    if (socket_.is_open())
      sessions_.emplace(session->tag, std::move(session));
  }

  void remove(const heartbeat_session* session) {
    const auto [begin, end] = sessions_.equal_range(session->tag);
    for (auto i = begin; i != end; ++i)
      if (i->second.get() == session) {
        sessions_.erase(i);
        return;
      }
  }

  void send(const std::shared_ptr<heartbeat_session>& session,
            heartbeat_kind kind, uint32_t sequence) {
    const heartbeat_packet packet{session->tag, kind, sequence};
    filtered(traffic_direction::outgoing, packet, [this, session, packet] {
      if (!socket_.is_open() || !session->place)
        return;
      const auto bytes =
          encode_heartbeat(packet, session->registration.agreement.keys.send);
      // A packet that cannot be sent is a packet that was lost.
      ::sendto(socket_.native_handle(), bytes.data(), bytes.size(),
               MSG_DONTWAIT | MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&*session->place),
               sizeof *session->place);
    });
  }

  void watch(std::function<void()> on_heartbeat) {
    on_any_heartbeat_ = std::move(on_heartbeat);
  }

  heartbeat_counters counters() const {
    return {accepted_, malformed_, unknown_, forged_, replayed_};
  }

private:
  void wait() {
    socket_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [self = shared_from_this()](error ec) {
                         if (!ec && self->socket_.is_open())
                           self->receive();
                       });
  }

  void receive() {
    for (int i = 0; i < burst && socket_.is_open(); ++i)
      if (!receive_one())
        break;
    if (socket_.is_open())
      wait();
  }

  /// False if there is nothing more.
  bool receive_one() {
    // More than a packet has, so that a longer one can be told.
    static_assert(heartbeat_packet::size < reach_packet_size);
    std::array<char, reach_packet_size> buffer{};
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const auto size = ::recvfrom(
        socket_.native_handle(), buffer.data(), buffer.size(), MSG_DONTWAIT,
        reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0)
      return errno != EAGAIN;
    on_packet({buffer.data(), static_cast<size_t>(size)}, from);
    return true;
  }

  void on_packet(std::string_view bytes, const sockaddr_in& from) {
    const auto packet = read_heartbeat(bytes);
    if (!packet) {
      on_other_packet(bytes, from);
      return;
    }
    const auto [begin, end] = sessions_.equal_range(packet->tag);
    if (begin == end) {
      ++unknown_;
      return;
    }
    // Two sessions may share a tag; their keys differ.
    for (auto i = begin; i != end; ++i)
      if (is_authentic_heartbeat(
              bytes, i->second->registration.agreement.keys.receive))
        return on_authentic(i->second, *packet, from);
    ++forged_;
  }

  void on_other_packet(std::string_view bytes, const sockaddr_in& from) {
    const auto answer = bytes.size() == reach_packet_size
                            ? reach_answer(bytes, site_.text())
                            : std::nullopt;
    if (!answer) {
      ++malformed_;
      return;
    }
    ::sendto(socket_.native_handle(), answer->data(), answer->size(),
             MSG_DONTWAIT | MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&from), sizeof from);
  }

  void on_authentic(std::shared_ptr<heartbeat_session> session,
                    const heartbeat_packet& packet, const sockaddr_in& from) {
    filtered(traffic_direction::incoming, packet,
             [this, session = std::move(session), packet, from] {
               if (!session->is_newer(packet)) {
                 ++replayed_;
                 return;
               }
               ++accepted_;
               session->remember(packet, from);
               if (on_any_heartbeat_)
                 core_->guarded([this] { on_any_heartbeat_(); });
               if (session->registration.on_heartbeat)
                 core_->guarded([&] {
                   session->registration.on_heartbeat(packet.kind,
                                                      packet.sequence);
                 });
             });
  }

  /// Does `action` as often and as late as the filter says.
  void filtered(traffic_direction direction, const heartbeat_packet& packet,
                const std::function<void()>& action) {
    using what = traffic_verdict::action;
    traffic_verdict verdict;
    if (filter_)
      core_->guarded([&] { verdict = filter_(direction, packet); });
    if (verdict.what == what::pass)
      return action();
    if (verdict.what == what::delay)
      return act_later(verdict.delay, action);
    if (verdict.what == what::repeat)
      for (unsigned i = 0; i < verdict.times; ++i)
        action();
  }

  void act_later(std::chrono::milliseconds delay,
                 const std::function<void()>& action) {
    auto timer =
        std::make_shared<boost::asio::steady_timer>(core_->context(), delay);
    timer->async_wait([self = shared_from_this(), timer, action](error) {
      if (self->socket_.is_open())
        action();
    });
  }

  std::shared_ptr<io_core> core_;
  boost::asio::posix::stream_descriptor socket_;
  heartbeat_filter filter_;
  site_secret site_;
  std::function<void()> on_any_heartbeat_;
  std::unordered_multimap<uint32_t, std::shared_ptr<heartbeat_session>>
      sessions_;
  std::atomic<uint64_t> accepted_{0};
  std::atomic<uint64_t> malformed_{0};
  std::atomic<uint64_t> unknown_{0};
  std::atomic<uint64_t> forged_{0};
  std::atomic<uint64_t> replayed_{0};
};

class heartbeat_link_handle : public heartbeat_link {
public:
  heartbeat_link_handle(std::shared_ptr<heartbeat_core> socket,
                        std::shared_ptr<heartbeat_session> session)
      : socket_(std::move(socket)), session_(std::move(session)) {
    socket_->core()->post(
        [socket = socket_, session = session_] { socket->add(session); });
  }

  ~heartbeat_link_handle() override {
    socket_->core()->post([socket = socket_, session = session_] {
      socket->remove(session.get());
    });
  }

  void send(heartbeat_kind kind, uint32_t sequence) override {
    if (sequence > heartbeat_packet::max_sequence)
      return;
    socket_->core()->post(
        [socket = socket_, session = session_, kind, sequence] {
          socket->send(session, kind, sequence);
        });
  }

private:
  std::shared_ptr<heartbeat_core> socket_;
  std::shared_ptr<heartbeat_session> session_;
};

class socket_handle : public heartbeat_socket {
public:
  socket_handle(std::shared_ptr<heartbeat_core> socket, uint16_t port)
      : socket_(std::move(socket)), port_(port) {
    socket_->core()->post([socket = socket_] { socket->run(); });
  }

  ~socket_handle() override {
    socket_->core()->post([socket = socket_] { socket->close(); });
  }

  uint16_t port() const override {
    return port_;
  }

  std::unique_ptr<heartbeat_link>
  register_session(heartbeat_registration registration) override {
    return std::make_unique<heartbeat_link_handle>(
        socket_, std::make_shared<heartbeat_session>(std::move(registration)));
  }

  heartbeat_counters counters() const override {
    return socket_->counters();
  }

  void watch(std::function<void()> on_heartbeat) override {
    socket_->core()->post(
        [socket = socket_, on_heartbeat = std::move(on_heartbeat)]() mutable {
          socket->watch(std::move(on_heartbeat));
        });
  }

private:
  std::shared_ptr<heartbeat_core> socket_;
  uint16_t port_;
};

} // namespace

edge_result<std::unique_ptr<heartbeat_socket>>
heartbeat_socket::open(io_thread& io, heartbeat_socket_options options) {
  auto bound = bind_udp(options.address, options.port);
  if (auto* why = std::get_if<edge_error>(&bound))
    return *why;
  const auto udp = std::get<bound_port>(bound);
  auto core = std::make_shared<heartbeat_core>(
      io.core(), udp.fd, std::move(options.filter), std::move(options.site));
  return std::make_unique<socket_handle>(std::move(core), udp.port);
}

} // namespace roscell
