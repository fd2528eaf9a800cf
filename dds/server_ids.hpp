#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace roscell {

/// The first half of a GUID, which all endpoints of a participant share.
using guid_prefix = std::array<std::uint8_t, 12>;

/// The prefix that ROS 2 users expect of discovery server `id`:
/// 44.53.ID.5f.45.50.52.4f.53.49.4d.41.
guid_prefix server_prefix(std::uint8_t id);

/// The id of the server that has `prefix`, none if it is no such prefix.
std::optional<std::uint8_t> server_id_of(const guid_prefix& prefix);

/// What ROS_DISCOVERY_SERVER is to say of server `id` at "ip:port". The id is
/// said by as many semicolons: without them a program finds nothing.
std::string ros_discovery_server(std::uint8_t id, const std::string& address);

} // namespace roscell
