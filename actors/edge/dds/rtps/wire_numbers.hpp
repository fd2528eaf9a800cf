#pragma once

#include "actors/edge/dds/rtps/submessages.hpp"
#include "dds/server_ids.hpp"

#include <cstdint>

/// INTERNAL to actors/edge/dds: writing numbers into an RTPS message that is
/// sound.
namespace roscell {

void put_word(wire_cursor at, std::uint32_t value);

void put_number(wire_cursor at, std::int64_t value);

/// Raises the sequence number there, and returns it. Leaves `at` behind it.
std::int64_t raise_number(wire_cursor& at, std::int64_t by);

/// Raises the number of a sample's identity in the inline QoS there, where the
/// sample is of `author`. The identity goes with the sample wherever it is
/// passed on, and of two samples the one with the higher number counts.
void raise_identity(wire_cursor qos, const guid_prefix& author,
                    std::int64_t by);

} // namespace roscell
