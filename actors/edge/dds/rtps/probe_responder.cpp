#include "actors/edge/dds/rtps/probe_responder.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <utility>

namespace roscell {

void probe_responder::speak_for(const guid_prefix& server,
                                const std::string& announcement) {
  std::lock_guard<std::mutex> lock{mutex_};
  reply_ = probe_reply(server, announcement);
}

bool probe_responder::take(std::uint8_t* message, std::size_t size,
                           const sockaddr_in& from) {
  const auto sender = probe_answer(message, size);
  if (!sender)
    return false;
  std::lock_guard<std::mutex> lock{mutex_};
  const auto said = own_announcement_in(message, size);
  if (!said || said->name != probe_name)
    return asked_.count(*sender) != 0;
  if (reply_.empty())
    return false;
  remember(*sender);
  // Who gets no answer asks again.
  sendto(socket_.fd(), reply_.data(), reply_.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&from), sizeof(from));
  return true;
}

void probe_responder::remember(const guid_prefix& who) {
  if (!asked_.insert(who).second)
    return;
  in_order_.push_back(who);
  if (in_order_.size() > most_remembered) {
    asked_.erase(in_order_.front());
    in_order_.pop_front();
  }
}

namespace {

using namespace std::chrono_literals;

/// Between questions; each is twice as long as the one before.
constexpr std::chrono::milliseconds first_interval = 2ms;
constexpr std::chrono::milliseconds max_interval = 250ms;

constexpr std::size_t max_introduction_bytes = 4096;

/// A message without a destination is for whoever gets it (RTPS 2.3, 8.3.7.7).
void address_to_anybody(std::vector<std::uint8_t>& message) {
  for_each_submessage(
      message.data(), message.size(), [](const submessage_view& x) {
        if (x.kind == submessage_kind::info_dst)
          std::fill_n(x.body.position(), x.body.size(), std::uint8_t{0});
        return true;
      });
}

std::optional<udp_socket> open_socket(const sockaddr_in& server) {
  auto bound = udp_socket::bind(address_text(server), 0);
  if (auto* socket = std::get_if<udp_socket>(&bound))
    return std::move(*socket);
  return std::nullopt;
}

} // namespace

server_readiness::server_readiness(const sockaddr_in& server,
                                   std::function<void()> announce)
    : server_(server), announce_(std::move(announce)),
      socket_(open_socket(server)) {}

server_readiness::~server_readiness() {
  for (const auto& prefix : asked_)
    send(probe_farewell(prefix));
}

std::optional<std::vector<std::uint8_t>>
server_readiness::wait(std::chrono::milliseconds limit) {
  const auto end = clock::now() + limit;
  auto interval = first_interval;
  while (socket_ && clock::now() < end) {
    // Another asker each time: a server answers each one once.
    asked_.push_back(make_probe_prefix());
    send(probe_question(asked_.back(), socket_->local()));
    announce_(); // Reaches those who asked before.
    if (auto heard = hear(std::min(end, clock::now() + interval)))
      return heard;
    interval = std::min(2 * interval, max_interval);
  }
  return std::nullopt;
}

void server_readiness::send(const std::vector<std::uint8_t>& bytes) {
  sendto(socket_->fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&server_), sizeof(server_));
}

std::optional<std::vector<std::uint8_t>>
server_readiness::hear(clock::time_point deadline) {
  std::vector<std::uint8_t> datagram(max_introduction_bytes);
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - clock::now());
    pollfd waiting{socket_->fd(), POLLIN, 0};
    if (left.count() <= 0
        || ::poll(&waiting, 1, static_cast<int>(left.count())) == 0)
      return std::nullopt;
    const auto size = recv(socket_->fd(), datagram.data(), datagram.size(), 0);
    if (size <= 0
        || !own_announcement_in(datagram.data(),
                                static_cast<std::size_t>(size)))
      continue;
    datagram.resize(static_cast<std::size_t>(size));
    address_to_anybody(datagram);
    return datagram;
  }
}

} // namespace roscell
