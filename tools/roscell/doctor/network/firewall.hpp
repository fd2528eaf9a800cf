#pragma once

#include "tools/roscell/doctor/bounded_command.hpp"
#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"
#include "tools/roscell/doctor/network/ruleset.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// A packet that other hosts send to a node, and what for.
struct needed_packet {
  arriving_packet packet;
  unsigned last_port = 0; ///< Of a range that begins with the packet's.
  std::string what;       ///< "requests and sessions".
};

std::vector<needed_packet> needed_packets(const checked_host& host);

/// @param listed what `nft -j list ruleset` has said.
findings judge_firewall(const command_result& listed,
                        const std::vector<needed_packet>& needed);

/// What is found where the kernel has rules that `nft` does not list, as those
/// tables of /proc/net/ip_tables_names have.
findings judge_older_rules(findings found, const std::string& tables);

findings check_firewall(const checked_host& host);

} // namespace roscell::cli
