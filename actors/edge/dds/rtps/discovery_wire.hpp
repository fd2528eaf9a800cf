#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// INTERNAL to this folder: reading RTPS as if every byte were a lie.
namespace roscell {

/// A place in a range of bytes. Reading beyond the end gives zeros and leaves
/// the cursor bad for good.
class wire_cursor {
public:
  wire_cursor(std::uint8_t* first, std::size_t size)
      : at_(first), end_(first + size) {}

  void little_endian(bool value) {
    little_endian_ = value;
  }

  bool is_little_endian() const {
    return little_endian_;
  }

  bool good() const {
    return good_;
  }

  /// Good, and nothing is left.
  bool at_end() const {
    return good_ && at_ == end_;
  }

  /// How much is left.
  std::size_t size() const {
    return static_cast<std::size_t>(end_ - at_);
  }

  std::uint8_t* position() const {
    return at_;
  }

  /// False, and bad, when there is not so much left.
  bool skip(std::size_t count);

  /// The next `count` bytes, in the same byte order; as a bad cursor when there
  /// are not so many.
  wire_cursor take(std::size_t count);

  std::uint8_t u8();
  std::uint16_t u16();
  std::uint32_t u32();
  std::uint32_t big_endian_u32();

  /// The high half comes first in either byte order.
  std::int64_t sequence_number();

private:
  std::uint8_t* at_;
  std::uint8_t* end_;
  bool little_endian_ = true;
  bool good_ = true;
};

/// How a datagram came.
enum class arrival { direct, multicast };

/// What a parameter list describes.
enum class described_entity { participant, writer, reader };

/// Checks the parameter lists of one submessage, turns parameters that must not
/// be read into padding, and hides from Fast DDS that a participant which came
/// by multicast takes answers (discovery_filter.cpp).
class parameter_guard {
public:
  parameter_guard(described_entity what, arrival how)
      : what_(what), how_(how) {}

  /// False when the list is not sound up to its sentinel. Leaves `in` behind
  /// the sentinel.
  bool make_safe(wire_cursor& in);

  /// Whether some list said whom it is about. If several do, they agree.
  bool has_key() const {
    return has_key_;
  }

private:
  bool is_key(wire_cursor value);

  described_entity what_;
  arrival how_;
  bool has_key_ = false;
  std::array<std::uint8_t, 16> key_{};
};

// INTERNAL to this folder.

/// Whether Fast DDS 2.9.1 can be given a datagram that an unauthenticated peer
/// sent to a participant without topics. Left to itself it trusts lengths
/// inside discovery data, and asserts, throws or reads beyond the end when they
/// lie: one datagram ends the process.
///
/// True for RTPS 2 messages of well-formed ACKNACK, HEARTBEAT, GAP, INFO_DST,
/// INFO_TS, PAD and DATA of the discovery writers, as all Fast DDS versions
/// send them. Parameters that describe types or security are turned into
/// padding, in place: no ROS 2 node needs them to be relayed, and reading them
/// is not safe.
///
/// A participant that came by multicast is made to look as if it took no
/// participants' data. Fast DDS would answer each newcomer at once, and send
/// the answer to everybody it knows, one by one: of 70 participants that
/// start together it makes 180 000 datagrams.
bool make_safe(std::uint8_t* datagram, std::size_t size,
               arrival how = arrival::direct);

} // namespace roscell
