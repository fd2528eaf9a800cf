#pragma once

#include <cstdint>
#include <string>
#include <system_error>
#include <variant>
#include <vector>

namespace roscell {

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
