#include "actors/edge/dds/discovery_seeker.hpp"

#include "actors/edge/dds/rtps/own_words.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace {

using namespace std::chrono_literals;

/// The first answer usually comes within a round-trip time; then a lost
/// datagram costs little.
constexpr auto first_interval = 20ms;

/// An answer that takes this long is worth a word to the person who waits.
constexpr auto patience = 1000ms;

/// More questions than this are not asked within the lease of a probe.
constexpr std::size_t max_remembered = 12;

/// More than a server of an earlier version puts into one datagram by itself.
constexpr std::size_t longest_answer = 8192;

int to_timeout(std::chrono::milliseconds limit) {
  return limit.count() < 0 ? -1 : static_cast<int>(limit.count());
}

/// ICMP errors wait in a queue of their own, and `poll` returns at once as
/// long as there are any.
void drain_errors(int fd) {
  std::array<char, 512> control{};
  msghdr message{};
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  while (recvmsg(fd, &message, MSG_ERRQUEUE | MSG_DONTWAIT) >= 0)
    message.msg_controllen = control.size();
}

edge_result<udp_socket> open_socket(const std::string& local_address) {
  auto result = udp_socket::bind(local_address, 0);
  // With this, a closed port is told to a socket that is not connected, as
  // ours must be: a server answers from another port than it listens on.
  int on = 1;
  if (auto* socket = std::get_if<udp_socket>(&result))
    setsockopt(socket->fd(), IPPROTO_IP, IP_RECVERR, &on, sizeof(on));
  return result;
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

server_seeker::server_seeker(const sockaddr_in& server,
                             std::string local_address,
                             std::chrono::milliseconds max_interval,
                             report_function report)
    : server_(server), local_address_(std::move(local_address)),
      max_interval_(max_interval), report_(std::move(report)) {}

std::optional<server_sighting> server_seeker::seek(wake_event& wake) {
  auto opened = open_socket(local_address_);
  if (auto* error = std::get_if<edge_error>(&opened)) {
    report(error->message);
    wake.wait(max_interval_);
    return std::nullopt;
  }
  auto& socket = std::get<udp_socket>(opened);
  auto begin = clock::now();
  std::chrono::milliseconds interval = first_interval;
  for (bool woken = false; !woken;) {
    ask(socket);
    if (auto found = await(socket, wake, clock::now() + interval, woken)) {
      say_farewell(socket);
      reported_.clear();
      return found;
    }
    if (reported_.empty() && clock::now() - begin > patience)
      report("no answer from " + endpoint_text(server_));
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
    auto size = recvfrom(socket.fd(), datagram.data(), datagram.size(), 0,
                         reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0 && errno == ECONNREFUSED) {
      report("nothing listens on UDP " + endpoint_text(server_));
      drain_errors(socket.fd());
      continue;
    }
    if (size < 0) {
      drain_errors(socket.fd());
      return std::nullopt;
    }
    datagram.resize(static_cast<std::size_t>(size));
    if (from.sin_addr.s_addr == server_.sin_addr.s_addr)
      if (auto found = sighting_in(datagram))
        return found;
  }
}

std::optional<server_sighting>
server_seeker::sighting_in(std::vector<std::uint8_t>& message) {
  const auto prefix = probe_answer(message.data(), message.size());
  if (!prefix)
    return std::nullopt;
  const auto id = server_id_of(*prefix);
  if (!id) {
    report("the discovery server at " + endpoint_text(server_)
           + " has the GUID prefix " + to_text(*prefix)
           + ", none of the well-known ones");
    return std::nullopt;
  }
  // One of an earlier version may first ask for more.
  auto said = own_words_in(message.data(), message.size());
  if (!said)
    return std::nullopt;
  return server_sighting{*id, *prefix, std::move(said->announcement)};
}

void server_seeker::say_farewell(const udp_socket& socket) {
  for (auto& prefix : asked_)
    send(socket, probe_farewell(prefix));
  asked_.clear();
}

void server_seeker::send(const udp_socket& socket,
                         const std::vector<std::uint8_t>& bytes) {
  auto* to = reinterpret_cast<const sockaddr*>(&server_);
  if (sendto(socket.fd(), bytes.data(), bytes.size(), 0, to, sizeof(server_))
          < 0
      && errno != ECONNREFUSED)
    report("cannot send to " + endpoint_text(server_) + ": "
           + std::strerror(errno));
}

void server_seeker::report(const std::string& reason) {
  if (reason == reported_)
    return;
  reported_ = reason;
  if (report_)
    report_(reason);
}

} // namespace roscell
