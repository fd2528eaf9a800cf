#pragma once

#include <cstddef>
#include <cstdint>

/// INTERNAL to this folder.
namespace roscell {

/// Whether Fast DDS 2.9.1 can be given a datagram that a stranger sent to a
/// participant without topics. Left to itself it trusts lengths inside
/// discovery data, and asserts, throws or reads beyond the end when they lie:
/// one datagram ends the process.
///
/// True for RTPS 2 messages of well-formed ACKNACK, HEARTBEAT, GAP, INFO_DST,
/// INFO_TS, PAD and DATA of the discovery writers, as all Fast DDS versions
/// send them. Parameters that describe types or security are turned into
/// padding, in place: no ROS 2 node needs them to be relayed, and reading them
/// is not safe.
bool make_safe(std::uint8_t* datagram, std::size_t size);

} // namespace roscell
