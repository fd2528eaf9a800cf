#pragma once

#include "tools/roscell/doctor/network/ruleset.hpp"

#include <map>
#include <string>

namespace roscell::cli {

/// INTERNAL to rulesets: whether a rule is for a packet.
enum class rule_match { no, maybe, yes };

/// Of all that the expressions of a rule ask for.
/// @param sets by their names, as nftables tells them.
rule_match match_rule(const json& expressions, const arriving_packet& packet,
                      const std::map<std::string, json>& sets);

/// Whether what a rule looks at (`left`, as nftables tells it) has for a packet
/// the value `right`, or is within it.
rule_match match_value(const json& left, const json& right,
                       const arriving_packet& packet,
                       const std::map<std::string, json>& sets);

} // namespace roscell::cli
