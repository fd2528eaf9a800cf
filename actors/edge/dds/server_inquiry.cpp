#include "actors/edge/dds/server_inquiry.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"
#include "actors/edge/host/interfaces.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace roscell {

namespace {

std::optional<edge_error> check(const server_inquiry_options& options) {
  if (to_socket_address(options.server_address, options.server_port)
      && options.server_port != 0)
    return std::nullopt;
  return edge_error{error_code::schema_violation,
                    "\"" + options.server_address.substr(0, 64) + ':'
                        + std::to_string(options.server_port)
                        + "\" is no IPv4 address and port",
                    ""};
}

edge_result<std::string> local_address(const server_inquiry_options& options) {
  if (options.address.empty())
    return local_address_towards(
        *to_socket_address(options.server_address, options.server_port));
  auto found = resolve_interface(options.address);
  if (auto* error = std::get_if<edge_error>(&found))
    return *error;
  return std::get<interface_address>(found).address;
}

} // namespace

class server_inquiry::impl {
public:
  impl(const server_inquiry_options& options, on_server_found callback)
      : callback_(std::move(callback)),
        seeker_(*to_socket_address(options.server_address, options.server_port),
                options.address, longest_pause),
        thread_([this] { run(); }) {}

  ~impl() {
    close();
  }

  void close() {
    closing_ = true;
    wake_.raise();
    if (thread_.joinable())
      thread_.join();
  }

private:
  void run() {
    while (!closing_)
      if (auto seen = seeker_.seek(wake_)) {
        report_change(*seen);
        wake_.wait(longest_pause);
      }
  }

  void report_change(const server_sighting& seen) {
    if (closing_ || known_ == seen.announcement)
      return;
    known_ = seen.announcement;
    callback_(seen);
  }

  const on_server_found callback_;
  wake_event wake_;
  std::atomic<bool> closing_{false};
  std::optional<std::string> known_; // What was told last.
  server_seeker seeker_;
  std::thread thread_; // Last: it uses all the others.
};

server_inquiry::server_inquiry(std::unique_ptr<impl> x) : impl_(std::move(x)) {}

edge_result<std::unique_ptr<server_inquiry>>
server_inquiry::open(const server_inquiry_options& options,
                     on_server_found callback) {
  if (auto error = check(options))
    return *std::move(error);
  auto address = local_address(options);
  if (auto* error = std::get_if<edge_error>(&address))
    return *error;
  auto resolved = options;
  resolved.address = std::get<std::string>(address);
  try {
    return std::unique_ptr<server_inquiry>{new server_inquiry(
        std::make_unique<impl>(resolved, std::move(callback)))};
  } catch (const std::system_error& why) {
    return edge_error{error_code::conflict,
                      "the discovery server is not looked for: no thread can "
                      "be had: "
                          + why.code().message(),
                      "raise the limit of processes: ulimit -u"};
  }
}

server_inquiry::~server_inquiry() = default;

void server_inquiry::close() {
  impl_->close();
}

namespace {

using namespace std::chrono_literals;

/// The first answer usually comes within a round-trip time; then a lost
/// datagram costs little.
constexpr auto first_interval = 20ms;

/// More questions than this are not asked within the lease of a probe.
constexpr std::size_t max_remembered = 12;

/// More than a server of an earlier version puts into one datagram by itself.
constexpr std::size_t longest_answer = 8192;

int to_timeout(std::chrono::milliseconds limit) {
  return limit.count() < 0 ? -1 : static_cast<int>(limit.count());
}

/// What a datagram tells of the server that has sent it; none: not enough, as
/// the first one of an earlier version may be.
std::optional<server_sighting> sighting_in(std::vector<std::uint8_t>& message) {
  const auto prefix = probe_answer(message.data(), message.size());
  const auto id = prefix ? server_id_of(*prefix) : std::nullopt;
  auto said =
      id ? own_announcement_in(message.data(), message.size()) : std::nullopt;
  if (!said)
    return std::nullopt;
  return server_sighting{*id, *prefix, std::move(said->announcement)};
}

} // namespace

wake_event::wake_event() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

wake_event::~wake_event() {
  ::close(fd_);
}

void wake_event::raise() {
  eventfd_write(fd_, 1);
}

bool wake_event::wait(std::chrono::milliseconds limit) {
  pollfd waiting{fd_, POLLIN, 0};
  while (poll(&waiting, 1, to_timeout(limit)) < 0 && errno == EINTR)
    continue;
  eventfd_t ignored = 0;
  return eventfd_read(fd_, &ignored) == 0;
}

std::optional<server_sighting> server_seeker::seek(wake_event& wake) {
  auto opened = udp_socket::bind(local_address_, 0);
  if (std::holds_alternative<edge_error>(opened)) {
    wake.wait(max_interval_);
    return std::nullopt;
  }
  auto& socket = std::get<udp_socket>(opened);
  std::chrono::milliseconds interval = first_interval;
  for (bool woken = false; !woken;) {
    ask(socket);
    if (auto found = await(socket, wake, clock::now() + interval, woken)) {
      say_farewell(socket);
      return found;
    }
    interval = std::min(2 * interval, max_interval_);
  }
  return std::nullopt;
}

void server_seeker::ask(const udp_socket& socket) {
  // Another asker each time: a server answers each one once.
  asked_.push_back(make_probe_prefix());
  if (asked_.size() > max_remembered)
    asked_.pop_front();
  send(socket, probe_question(asked_.back(), socket.local()));
}

std::optional<server_sighting> server_seeker::await(const udp_socket& socket,
                                                    wake_event& wake,
                                                    clock::time_point deadline,
                                                    bool& woken) {
  for (;;) {
    auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - clock::now());
    if (left.count() <= 0)
      return std::nullopt;
    std::array<pollfd, 2> waiting{
        {{socket.fd(), POLLIN, 0}, {wake.fd(), POLLIN, 0}}};
    if (poll(waiting.data(), waiting.size(), to_timeout(left)) < 0)
      continue;
    if (waiting[1].revents != 0) {
      woken = wake.wait(0ms);
      return std::nullopt;
    }
    if (waiting[0].revents != 0)
      if (auto found = receive(socket))
        return found;
  }
}

std::optional<server_sighting>
server_seeker::receive(const udp_socket& socket) {
  std::vector<std::uint8_t> datagram;
  sockaddr_in from{};
  socklen_t from_size = sizeof(from);
  for (;;) {
    datagram.resize(longest_answer);
    const auto size = recvfrom(socket.fd(), datagram.data(), datagram.size(), 0,
                               reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0)
      return std::nullopt;
    datagram.resize(static_cast<std::size_t>(size));
    // It answers from another port than it listens on.
    if (from.sin_addr.s_addr != server_.sin_addr.s_addr)
      continue;
    if (auto found = sighting_in(datagram))
      return found;
    answer(socket, datagram);
  }
}

/// A server of an earlier version takes who asks for a client, and tells it by
/// a HEARTBEAT that there is something to be asked for.
void server_seeker::answer(const udp_socket& socket,
                           std::vector<std::uint8_t>& datagram) {
  for (const auto& self : asked_) {
    const auto message =
        heartbeat_answer(self, answers_ + 1, datagram.data(), datagram.size());
    if (message.empty())
      continue;
    ++answers_;
    send(socket, message);
  }
}

void server_seeker::say_farewell(const udp_socket& socket) {
  for (auto& prefix : asked_)
    send(socket, probe_farewell(prefix));
  asked_.clear();
}

/// What is lost, or cannot be sent now, is asked again.
void server_seeker::send(const udp_socket& socket,
                         const std::vector<std::uint8_t>& bytes) {
  sendto(socket.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&server_), sizeof(server_));
}

} // namespace roscell
