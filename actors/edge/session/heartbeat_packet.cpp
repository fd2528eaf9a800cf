#include "actors/edge/session/heartbeat_packet.hpp"

#include <algorithm>

namespace roscell {

namespace {

constexpr size_t signed_size = 8;
constexpr size_t mac_size = 8;

void put(char* to, uint32_t value) {
  for (const int shift : {24, 16, 8, 0})
    *to++ = static_cast<char>((value >> shift) & 0xff);
}

uint32_t get(std::string_view bytes) {
  uint32_t result = 0;
  for (const char c : bytes.substr(0, 4))
    result = (result << 8) | static_cast<uint8_t>(c);
  return result;
}

} // namespace

uint32_t heartbeat_tag(std::string_view session) {
  const auto bytes = from_hex(session.substr(0, 8));
  return bytes ? get(*bytes) : 0;
}

heartbeat_bytes encode_heartbeat(const heartbeat_packet& packet,
                                 const digest& key) {
  heartbeat_bytes result{};
  put(result.data(), packet.tag);
  put(result.data() + 4,
      ((static_cast<uint32_t>(packet.kind) + 1) << 28)
          | (packet.sequence & heartbeat_packet::max_sequence));
  const auto mac = hmac_sha256(as_bytes(key), {result.data(), signed_size});
  std::copy_n(mac.begin(), mac_size, result.begin() + signed_size);
  return result;
}

std::optional<heartbeat_packet> read_heartbeat(std::string_view bytes) {
  if (bytes.size() != heartbeat_packet::size)
    return std::nullopt;
  const auto word = get(bytes.substr(4));
  const auto kind = word >> 28;
  if (kind < 1 || kind > enum_words(heartbeat_kind{}).size())
    return std::nullopt;
  return heartbeat_packet{get(bytes), static_cast<heartbeat_kind>(kind - 1),
                          word & heartbeat_packet::max_sequence};
}

bool is_authentic_heartbeat(std::string_view bytes, const digest& key) {
  const auto mac = hmac_sha256(as_bytes(key), bytes.substr(0, signed_size));
  return equal_in_constant_time(bytes.substr(signed_size),
                                as_bytes(mac).substr(0, mac_size));
}

} // namespace roscell
