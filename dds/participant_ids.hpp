#pragma once

#include <fastdds/rtps/common/Locator.h>

#include <cstdint>
#include <string>

namespace roscell {

/// A participant id above those that Fast DDS hands out. Fast DDS makes the
/// GUID of a participant of the process id and 16 random bits, and processes in
/// containers have the same few process ids; with an id of its own, one that
/// replaces another has another GUID, also when the farewell of the first got
/// lost. Fast DDS derives a port from the id, which must stay below 65536.
std::int32_t make_participant_id();

eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                std::uint32_t port);

} // namespace roscell
