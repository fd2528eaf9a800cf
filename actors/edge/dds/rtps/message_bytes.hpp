#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

/// INTERNAL to this folder: writing RTPS messages from nothing.
namespace roscell {

using message_bytes = std::vector<std::uint8_t>;

/// Of what tells of participants.
constexpr std::array<std::uint8_t, 4> pdp_writer_entity{0, 1, 0, 0xc2};
constexpr std::array<std::uint8_t, 4> pdp_reader_entity{0, 1, 0, 0xc7};

/// "RTPS", protocol 2.3, vendor eProsima: servers of Fast DDS take no other.
constexpr std::array<std::uint8_t, 8> rtps_header{'R', 'T', 'P', 'S',
                                                  2,   3,   1,   0x0f};

template <class Range>
void put_all(message_bytes& to, const Range& range) {
  to.insert(to.end(), std::begin(range), std::end(range));
}

/// Everything here is little-endian, as the submessage's flag E says.
template <class T>
void put(message_bytes& to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void put_sequence_number(message_bytes& to, std::uint32_t number) {
  put(to, std::uint32_t{0}); // The high half comes first.
  put(to, number);
}

} // namespace roscell
