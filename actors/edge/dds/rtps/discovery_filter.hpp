#pragma once

#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include <cstddef>
#include <cstdint>

/// INTERNAL to this folder.
namespace roscell {

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
