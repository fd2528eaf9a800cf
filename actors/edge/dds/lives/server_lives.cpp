#include "actors/edge/dds/lives/server_lives.hpp"

#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>
#include <cstring>

namespace roscell {

namespace {

constexpr std::size_t prefix_bytes = std::tuple_size<guid_prefix>::value;
constexpr std::size_t life_bytes = 4;
constexpr std::size_t life_at = prefix_bytes - life_bytes;

/// The first byte of the lives after the first one, which has a letter there.
constexpr std::uint8_t later_life = 0;

std::array<std::uint8_t, life_bytes> ending_of(std::uint32_t life) {
  if (life == 0)
    return {'S', 'I', 'M', 'A'};
  return {later_life, static_cast<std::uint8_t>(life >> 16),
          static_cast<std::uint8_t>(life >> 8),
          static_cast<std::uint8_t>(life)};
}

/// Whether a server's prefix begins there, of whichever life.
bool begins_server(const std::uint8_t* at) {
  static const auto model = server_prefix(0);
  return at[0] == model[0] && at[1] == model[1]
         && std::equal(at + 3, at + life_at, model.begin() + 3);
}

bool is_first_life(const std::uint8_t* at) {
  const auto first = ending_of(0);
  return std::equal(first.begin(), first.end(), at + life_at);
}

/// `visit` gets each place where a prefix of a server begins.
template <class Visit>
void for_each_server(std::uint8_t* first, std::size_t size, Visit visit) {
  auto* const end = first + size;
  while (static_cast<std::size_t>(end - first) >= prefix_bytes) {
    const auto places =
        static_cast<std::size_t>(end - first) - prefix_bytes + 1;
    auto* at = static_cast<std::uint8_t*>(
        std::memchr(first, server_prefix(0)[0], places));
    if (at == nullptr)
      return;
    const bool found = begins_server(at);
    if (found)
      visit(at);
    first = at + (found ? prefix_bytes : 1);
  }
}

} // namespace

guid_prefix server_lives::present(std::uint8_t id) const {
  auto result = server_prefix(id);
  const auto ending = ending_of(peers_[id].life);
  std::copy(ending.begin(), ending.end(), result.begin() + life_at);
  return result;
}

bool server_lives::is_server(const guid_prefix& prefix) {
  return begins_server(prefix.data())
         && (prefix[life_at] == later_life || is_first_life(prefix.data()));
}

bool server_lives::is_another_server(const guid_prefix& prefix) const {
  return is_server(prefix) && id_of(prefix) != own_;
}

void server_lives::lose(std::uint8_t id) {
  peers_[id].heard_from = time_point::max();
  peers_[id].spoken = false;
  // Three bytes of a life are told apart.
  constexpr std::uint32_t lives = 1U << 24;
  peers_[id].life = std::max(1U, (peers_[id].life + 1) % lives);
}

void server_lives::meet(std::uint8_t id, time_point now) {
  peers_[id].heard_from = has_been_lost(id) ? now + settling : now;
}

bool server_lives::is_met(std::uint8_t id) const {
  const auto from = peers_[id].heard_from.load();
  return from != unmet && from != time_point::max();
}

void server_lives::ignore(std::uint8_t id) {
  peers_[id].heard_from = time_point::max();
}

bool server_lives::take_in(std::uint8_t* datagram, std::size_t size,
                           time_point now) {
  constexpr std::size_t sender_at = 8;
  if (size < sender_at + prefix_bytes)
    return false;
  const auto* sender = datagram + sender_at;
  const bool is_of_peer = begins_server(sender) && sender[2] != own_;
  auto& peer = peers_[sender[2]];
  const std::uint32_t life = peer.life;
  if (is_of_peer && now < peer.heard_from.load())
    return false;
  for_each_server(datagram, size, [this](std::uint8_t* at) {
    if (at[2] == own_ || !is_first_life(at))
      return;
    const auto ending = ending_of(peers_[at[2]].life);
    std::copy(ending.begin(), ending.end(), at + life_at);
  });
  // Lost meanwhile by another thread, it would have spoken in its next life.
  if (is_of_peer && peer.life != life)
    return false;
  peer.spoken = peer.spoken || is_of_peer;
  return true;
}

bool server_lives::let_out(std::uint8_t* datagram, std::size_t size) const {
  const bool lives =
      for_each_submessage(datagram, size, [this](const submessage_view& x) {
        if (x.kind != submessage_kind::info_dst || x.body.size() < prefix_bytes)
          return true;
        guid_prefix to{};
        std::copy_n(x.body.position(), prefix_bytes, to.begin());
        return !is_another_server(to) || to == present(id_of(to));
      });
  for_each_server(datagram, size, [this](std::uint8_t* at) {
    if (at[2] == own_ || at[life_at] != later_life)
      return;
    const auto first = ending_of(0);
    std::copy(first.begin(), first.end(), at + life_at);
  });
  return lives;
}

bool introduction_pacing::ask(std::uint8_t id, time_point now) {
  auto& x = paces_[id];
  if (now < x.next)
    return false;
  if (now >= x.next + longest_pause)
    x.pause = first_pause;
  x.next = now + x.pause;
  x.pause = std::min(2 * x.pause, longest_pause);
  return true;
}

void introduction_pacing::forget(std::uint8_t id) {
  paces_[id] = {};
}

} // namespace roscell
