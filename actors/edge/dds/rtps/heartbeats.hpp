#pragma once

#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// What a server of an earlier version wants to hear before it sends its own
/// data: the answer, number `count` of the prober, to a HEARTBEAT of its
/// participants' writer, which asks for all that it has. Empty: `datagram`
/// holds none that is for `self`.
std::vector<std::uint8_t> heartbeat_answer(const guid_prefix& self,
                                           std::uint32_t count,
                                           std::uint8_t* datagram,
                                           std::size_t size);

/// HEARTBEATs of all writers of a discovery server: nothing is written yet.
std::vector<std::uint8_t> first_heartbeats(const guid_prefix& server);

} // namespace roscell
