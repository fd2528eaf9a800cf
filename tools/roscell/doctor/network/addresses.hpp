#pragma once

#include "actors/edge/host/interfaces.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <optional>
#include <string>
#include <vector>

/// The interface that a node's traffic goes through.
namespace roscell::cli {

/// What the kernel tells of an interface.
struct link_readings {
  bool exists = false;
  bool up = false;
  bool carrier = false; ///< A cable, an access point, the other end.
  bool multicast = false;
  int mtu = 0;
};

link_readings read_link_state(const std::string& name);

/// The address that is meant: that of `wanted`, or else the first.
std::optional<interface_address>
checked_address(const std::string& wanted,
                const std::vector<interface_address>& all);

/// @param link of the interface that was found, or of the name in `wanted`.
finding judge_interface(const std::string& wanted,
                        const std::vector<interface_address>& all,
                        const link_readings& link);

finding judge_mtu(const interface_address& at, const link_readings& link);

/// Where this host sends what goes to 239.255.0.1.
struct multicast_route {
  int error = 0;       ///< Of the kernel; 0: there is a route.
  std::string address; ///< Of the interface that it leads to.
};

multicast_route read_multicast_route();

finding judge_multicast(const interface_address& at, const link_readings& link,
                        const multicast_route& route);

findings check_interface(const checked_host& host);
findings check_mtu(const checked_host& host);
findings check_multicast(const checked_host& host);

} // namespace roscell::cli
