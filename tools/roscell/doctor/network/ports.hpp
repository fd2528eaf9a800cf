#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

/// The ports that a node and its skills listen at.
namespace roscell::cli {

/// From the first to the last.
struct port_range {
  unsigned first;
  unsigned last;
};

/// All ports of DDS in a domain (RTPS 2.3, 9.6.1.1).
port_range ports_of_domain(unsigned domain);

/// Those by which nodes of a site find each other.
port_range public_ports(unsigned domain);

/// A port that a node needs.
struct port_readings {
  std::string protocol; ///< "tcp" or "udp".
  uint16_t port = 0;
  int error = 0;      ///< Of binding it; 0: it is free.
  std::string holder; ///< "pid 12 (name)"; empty: not known.
  int64_t pid = 0;    ///< 0: not known.
};

/// @param vital a node cannot start without it.
finding judge_port(const port_readings& readings, bool vital);

/// A node has the ports, and this program had not been told where it is.
/// @param address "ip:port" of its HTTP.
finding judge_node_there(const std::string& name, const std::string& address);

/// Ports that the kernel gives to whoever asks for any.
struct ephemeral_readings {
  port_range range{0, 0};
  std::vector<port_range> reserved; ///< Which are not given away.
  std::string reserved_text;        ///< The same as the kernel tells them.
};

/// "11811,32150-32166"; what is none of it is left out.
std::vector<port_range> parse_port_ranges(const std::string& text);

finding judge_ephemeral(const ephemeral_readings& readings,
                        const std::vector<port_range>& wanted);

/// The ports of a domain that a ROS 2 program tries one after the other until
/// one is free; Fast DDS gives up after them. Those of messages are one above.
std::vector<unsigned> program_ports(unsigned domain);

/// @param bound UDP ports of this host that are in use.
finding judge_domain(unsigned domain, const std::set<unsigned>& bound);

findings check_node_ports(const checked_host& host);
findings check_dds_ports(const checked_host& host);

} // namespace roscell::cli
