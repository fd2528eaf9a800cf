#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "tools/roscell/doctor/check.hpp"
#include "tools/roscell/doctor/network/ports.hpp"

#include <string>
#include <vector>

/// What stands between this host and others. Whether a packet passes is not
/// worked out: `roscell doctor --cell` sends real ones.
namespace roscell::cli {

/// Ports that other hosts send to.
struct needed_ports {
  std::vector<port_range> tcp; ///< Requests and sessions.
  std::vector<port_range> udp; ///< Heartbeats, discovery, topics of skills.
};

needed_ports ports_of_node(const checked_host& host);

/// A finding for each chain that packets from other hosts go through and whose
/// policy, or a rule of whose table, drops or rejects.
/// @param listed what `nft -j list ruleset` has said, or why it has not.
findings judge_firewall(const edge_result<std::string>& listed,
                        const needed_ports& needed);

/// What is found where the kernel has rules that `nft` does not list, as those
/// tables of /proc/net/ip_tables_names have.
findings judge_older_rules(findings found, const std::string& tables);

findings check_firewall(const checked_host& host);

} // namespace roscell::cli
