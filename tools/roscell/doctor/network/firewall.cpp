#include "tools/roscell/doctor/network/firewall.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/ports.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds nft_limit{3};

/// Where skills begin to look for a free port
/// (skills/ros2/participant_qos.cpp).
constexpr unsigned first_skill_place = 90;

/// The command that lets packets in, in the words of who wrote the rules.
std::string let_in(const packet_verdict& decided, const needed_packet& needed) {
  const auto& protocol = needed.packet.protocol;
  const auto ports = [&](const char* between) {
    const auto first = std::to_string(needed.packet.port);
    return needed.last_port <= needed.packet.port
               ? first
               : first + between + std::to_string(needed.last_port);
  };
  if (decided.table == "firewalld")
    return "sudo firewall-cmd --permanent --add-port=" + ports("-") + "/"
           + protocol + " && sudo firewall-cmd --reload";
  if (decided.by_ufw)
    return "sudo ufw allow " + ports(":") + "/" + protocol;
  return "sudo nft insert rule " + shell_word(decided.family) + " "
         + shell_word(decided.table) + " " + shell_word(decided.chain) + " "
         + protocol + " dport " + ports("-") + " accept";
}

/// What shows the rules that a packet depends on.
std::string show_rules(const packet_verdict& decided) {
  if (decided.table == "firewalld")
    return "sudo firewall-cmd --list-all-zones";
  if (decided.by_ufw)
    return "sudo ufw status verbose";
  return "sudo nft -a list chain " + shell_word(decided.family) + " "
         + shell_word(decided.table) + " " + shell_word(decided.chain);
}

finding judge_needed(const packet_verdict& decided,
                     const needed_packet& needed) {
  const auto& packet = needed.packet;
  const auto port = packet.protocol + " port " + std::to_string(packet.port);
  const auto chain =
      " (" + decided.family + " " + decided.table + " " + decided.chain + ")";
  if (decided.fate == packet_fate::dropped)
    return {judgement::broken, port + " is closed by " + decided.why + chain,
            "other nodes need it for " + needed.what, let_in(decided, needed)};
  return {judgement::warning,
          "whether " + port + " is open depends on " + decided.why + chain,
          "other nodes need it for " + needed.what
              + ", and the rule asks for more than port and protocol",
          show_rules(decided)};
}

finding not_listed(const command_result& listed) {
  if (listed.code == command_not_found)
    return {judgement::skipped,
            "there is no program `nft` that lists its rules",
            {},
            "sudo apt-get install nftables"};
  if (listed.code == command_took_too_long)
    return {judgement::skipped, "`nft list ruleset` did not end in time"};
  const bool forbidden =
      listed.said.find("Operation not permitted") != std::string::npos;
  return {judgement::skipped,
          forbidden ? "only root may list its rules"
                    : "`nft list ruleset`: "
                          + listed.said.substr(0, listed.said.find('\n')),
          {},
          forbidden ? "sudo roscell doctor --only firewall" : ""};
}

} // namespace

std::vector<needed_packet> needed_packets(const checked_host& host) {
  const auto& config = host.config;
  const auto at = checked_address(host.interface, list_interfaces());
  const auto by = at ? at->name : std::string{};
  std::vector<needed_packet> result;
  const auto add = [&](const char* protocol, port_range ports,
                       const char* what) {
    if (ports.first != 0)
      result.push_back({{protocol, ports.first, by}, ports.last, what});
  };
  const auto skills = ports_of_domain(config.ros_domain_id);
  const port_range http{config.http_port, config.http_port};
  add("tcp", http, "requests and sessions");
  add("udp", http, "heartbeats");
  add("udp", {config.discovery_port, config.discovery_port},
      "the discovery server");
  add("udp", public_ports(config.public_domain_id),
      "finding the cells of a site");
  add("udp", {skills.first + first_skill_place, skills.last},
      "the topics of skills, there and above");
  return result;
}

findings judge_firewall(const command_result& listed,
                        const std::vector<needed_packet>& needed) {
  const auto ruleset = json::parse(listed.said, nullptr, false);
  if (listed.code != 0 || !ruleset.is_object())
    return {not_listed(listed)};
  findings result;
  for (const auto& x : needed) {
    const auto decided = judge_packet(ruleset, x.packet);
    if (decided.fate != packet_fate::accepted)
      result.push_back(judge_needed(decided, x));
  }
  if (result.empty())
    result.push_back({judgement::ok, "nftables lets the packets of a node in"});
  return result;
}

findings judge_older_rules(findings found, const std::string& tables) {
  if (tables.empty())
    return found;
  found.erase(
      std::remove_if(found.begin(), found.end(),
                     [](const auto& x) { return x.how == judgement::ok; }),
      found.end());
  found.push_back({judgement::skipped,
                   "there are rules of iptables-legacy, which nftables does "
                   "not tell of",
                   "", "sudo iptables-legacy -S INPUT"});
  return found;
}

findings check_firewall(const checked_host& host) {
  constexpr size_t most_names = 256;
  return judge_older_rules(
      judge_firewall(
          run_bounded({host.nft, "-j", "list", "ruleset"}, nft_limit),
          needed_packets(host)),
      read_small_file(host.proc + "/net/ip_tables_names", most_names)
          .value_or(""));
}

} // namespace roscell::cli
