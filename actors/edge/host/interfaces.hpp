#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// One IPv4 address of one network interface that is up.
struct interface_address {
  std::string name;      ///< "eth0".
  std::string address;   ///< "10.0.0.5".
  std::string mac;       ///< "0242ac110002", empty if it has none.
  bool loopback = false; ///< The address never leaves this host.
  bool hardware = false; ///< A device of this machine, no bridge or tunnel.
  /// Packets can leave: a cable is in, or a radio has found its network.
  bool carrier = true;
};

/// A network interface, whether it is up or not, with an address or not.
struct host_link {
  std::string name;
  bool up = false;
};

/// Puts interfaces of hardware first, loopback last, each group ordered by
/// name, so that the order is the same after a restart. Addresses of one
/// interface stay as they are.
void order_interfaces(std::vector<interface_address>& all);

/// All IPv4 addresses of this host, in that order; those of one interface as
/// the kernel has them: the primary one, which packets leave with, before those
/// that were added to it.
std::vector<interface_address> list_interfaces();

/// All interfaces of this host, in the order of their names.
std::vector<host_link> list_links();

/// "eth0 10.0.0.5, lo 127.0.0.1", for messages to a person.
std::string describe_interfaces(const std::vector<interface_address>& all);

/// The address meant by `text`: an interface's name, then its primary
/// address, or one of this host's addresses. Anything else is refused with
/// `unreachable`, and the hint lists what there is.
edge_result<interface_address>
resolve_interface(std::string_view text,
                  const std::vector<interface_address>& all);

/// The same on this host's own interfaces.
edge_result<interface_address> resolve_interface(std::string_view text);

/// A name for a node that was given none: "node-" and the MAC of `chosen`, an
/// interface's name or address. If that is empty or has no MAC, the MAC of the
/// first interface in the order of `list_interfaces` that has one; without any,
/// what is usable of `hostname`.
std::string mac_node_name(std::string_view chosen,
                          const std::vector<interface_address>& all,
                          std::string_view hostname);

/// The same for this host. A host whose only address is loopback still has
/// network devices, whose MACs then count.
std::string mac_node_name(std::string_view chosen = {});

/// Tells the hosts of the subnet which of them has this IPv4 address, one of
/// this host, so that whoever has sent its packets to another host sends them
/// here again: after a host that had the same address has gone, others would go
/// on for up to a minute. One packet, an ARP announcement as of RFC 5227, to
/// the interface that has the address. Without the right to send it
/// (CAP_NET_RAW), and where the interface knows no ARP, nothing happens.
void claim_address(const std::string& address);

} // namespace roscell
