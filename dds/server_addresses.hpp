#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

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

/// The first of `places` UDP ports from `first` on, two apart as RTPS has them,
/// that is free on every one of `addresses` (IPv4, of this host), else any port
/// that is; or what the system says where there is none. Fast DDS by itself
/// looks at a hundred places and then goes on without a port: no more processes
/// than that could share an address. Whoever takes the port before the caller
/// does makes Fast DDS try those that follow.
std::variant<std::uint16_t, std::error_code>
free_port(const std::vector<std::string>& addresses, std::uint16_t first,
          unsigned places);

} // namespace roscell
