#pragma once

#include <cstdint>
#include <set>
#include <string>

/// INTERNAL to ports: who has bound what.
namespace roscell::cli {

struct port_holder {
  int64_t pid = 0; ///< 0: not known.
  std::string program;
};

/// Which process holds a port, as far as this user may know.
/// @param protocol "tcp" or "udp".
port_holder find_port_holder(const std::string& proc,
                             const std::string& protocol, unsigned port);

/// The name of the node whose HTTP port that is; empty: it is none's.
std::string node_at(const std::string& address, uint16_t port);

/// The local ports of a table like /proc/net/udp.
std::set<unsigned> ports_in(const std::string& table);

/// All UDP ports that are bound in this network namespace.
std::set<unsigned> bound_udp_ports(const std::string& proc);

} // namespace roscell::cli
