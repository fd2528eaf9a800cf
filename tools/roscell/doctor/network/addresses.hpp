#pragma once

#include "actors/edge/host/interfaces.hpp"
#include "tools/roscell/doctor/examined_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <optional>
#include <string>
#include <vector>

/// The interface that a node's traffic goes through.
namespace roscell::cli {

/// What the kernel tells of an interface.
struct link_facts {
  bool exists = false;
  bool up = false;
  bool carrier = false; ///< A cable, an access point, the other end.
  bool multicast = false;
  int mtu = 0;
};

link_facts look_at_link(const std::string& name);

/// The address that is meant: that of `wanted`, or else the first.
std::optional<interface_address>
examined_address(const std::string& wanted,
                 const std::vector<interface_address>& all);

/// @param link of the interface that was found, or of the name in `wanted`.
finding judge_interface(const std::string& wanted,
                        const std::vector<interface_address>& all,
                        const link_facts& link);

finding judge_mtu(const interface_address& at, const link_facts& link);

/// Where this host sends what goes to 239.255.0.1.
struct multicast_route {
  int error = 0;       ///< Of the kernel; 0: there is a route.
  std::string address; ///< Of the interface that it leads to.
};

multicast_route look_at_multicast_route();

finding judge_multicast(const interface_address& at, const link_facts& link,
                        const multicast_route& route);

findings examine_interface(const examined_host& host);
findings examine_mtu(const examined_host& host);
findings examine_multicast(const examined_host& host);

} // namespace roscell::cli
