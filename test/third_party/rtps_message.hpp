#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

/// What the gate needs of RTPS messages, which it takes apart and puts together
/// again. Reading beyond the end gives zeros.
namespace rtps {

constexpr std::size_t header_bytes = 20;
constexpr std::size_t prefix_at = 8;

/// Submessages of RTPS 2.3, 8.3.7.
constexpr std::uint8_t acknack = 0x06;
constexpr std::uint8_t heartbeat = 0x07;
constexpr std::uint8_t gap = 0x08;
constexpr std::uint8_t info_dst = 0x0e;
constexpr std::uint8_t data = 0x15;

constexpr std::uint8_t little_endian = 1;
constexpr std::uint8_t with_inline_qos = 2;

/// Of RTPS 2.3, 9.6.2.2.2; the last one is Fast DDS's own.
constexpr std::uint16_t pid_sentinel = 0x0001;
constexpr std::uint16_t pid_vendor_id = 0x0016;
constexpr std::uint16_t pid_metatraffic_unicast = 0x0032;
constexpr std::uint16_t pid_metatraffic_multicast = 0x0033;
constexpr std::uint16_t pid_property_list = 0x0059;
constexpr std::uint16_t pid_sample_identity = 0x800f;

constexpr char participant_writer[] = "\x00\x01\x00\xc2";
constexpr char participant_reader[] = "\x00\x01\x00\xc7";

/// Value at `at` of a datagram, or 0 beyond its end.
template <class T>
T get(const std::string& from, std::size_t at) {
  T result{};
  if (at + sizeof result <= from.size())
    std::memcpy(&result, from.data() + at, sizeof result);
  return result;
}

template <class T>
void append(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Sequence numbers are two words, the high one first.
inline std::int64_t get_number(const std::string& from, std::size_t at) {
  return (std::int64_t{get<std::int32_t>(from, at)} << 32)
         + get<std::uint32_t>(from, at + 4);
}

inline void append_number(std::string& to, std::int64_t value) {
  append(to, static_cast<std::int32_t>(value >> 32));
  append(to, static_cast<std::uint32_t>(value));
}

/// Calls `use(id, begin, size)` with each parameter's value of the list at
/// `at`; returns the end of the list.
template <class Use>
std::size_t walk_parameters(std::string& in, std::size_t at, Use use) {
  while (at + 4 <= in.size()) {
    const auto id = get<std::uint16_t>(in, at);
    const std::size_t size = get<std::uint16_t>(in, at + 2);
    at += 4;
    if (id == pid_sentinel || at + size > in.size())
      break;
    use(id, at, size);
    at += size;
  }
  return at;
}

/// All kinds that matter here begin with reader and writer.
struct submessage {
  std::uint8_t kind;
  std::string bytes; ///< With its header of 4 bytes.

  std::uint8_t flags() const {
    return static_cast<std::uint8_t>(bytes[1]);
  }

  bool is_of_participant_writer() const {
    const std::size_t at = kind == data ? 12 : 8;
    return bytes.size() >= at + 4
           && std::memcmp(bytes.data() + at, participant_writer, 4) == 0;
  }

  /// Of DATA: where its parameter list begins.
  std::size_t payload() {
    std::size_t result = inline_qos;
    if ((flags() & with_inline_qos) != 0)
      result = walk_parameters(bytes, result, [](auto, auto, auto) {});
    return result + 4;
  }

  void insert(std::size_t at, const std::string& added) {
    bytes.insert(std::min(at, bytes.size()), added);
    const auto size = static_cast<std::uint16_t>(bytes.size() - 4);
    std::memcpy(bytes.data() + 2, &size, sizeof size);
  }

  static constexpr std::size_t inline_qos = 24; ///< Of DATA, if it has them.
};

/// Calls `use` with each submessage of a datagram, and returns the datagram of
/// what it makes of them.
template <class Use>
std::string map_submessages(const std::string& datagram, Use use) {
  auto result = datagram.substr(0, header_bytes);
  for (auto at = header_bytes; at + 4 <= datagram.size();) {
    std::size_t size = get<std::uint16_t>(datagram, at + 2);
    size = size == 0 ? datagram.size() - at : size + 4;
    submessage part{static_cast<std::uint8_t>(datagram[at]),
                    datagram.substr(at, size)};
    if ((part.flags() & little_endian) != 0)
      use(part);
    result += part.bytes;
    at += size;
  }
  return result;
}

} // namespace rtps
