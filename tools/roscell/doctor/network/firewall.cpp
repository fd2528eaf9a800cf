#include "tools/roscell/doctor/network/firewall.hpp"

#include "tools/roscell/doctor/network/addresses.hpp"
#include "tools/roscell/doctor/network/ports.hpp"

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds nft_limit{3};

/// Where skills begin to look for a free port
/// (skills/ros2/participant_qos.cpp).
constexpr unsigned first_skill_place = 90;

/// The command that lets a packet in, in the words of who wrote the rules.
std::string let_in(const packet_verdict& decided,
                   const arriving_packet& packet) {
  const auto port = std::to_string(packet.port);
  if (decided.table == "firewalld")
    return "firewall-cmd --permanent --add-port=" + port + "/" + packet.protocol
           + " && firewall-cmd --reload";
  if (decided.why.find("ufw-") != std::string::npos)
    return "ufw allow " + port + "/" + packet.protocol;
  return "nft insert rule " + decided.family + " " + decided.table + " "
         + decided.chain + " " + packet.protocol + " dport " + port + " accept";
}

finding judge_needed(const packet_verdict& decided,
                     const needed_packet& needed) {
  const auto& packet = needed.packet;
  const auto port = packet.protocol + " port " + std::to_string(packet.port);
  const auto chain =
      " (" + decided.family + " " + decided.table + " " + decided.chain + ")";
  if (decided.fate == packet_fate::dropped)
    return {judgement::broken, port + " is closed by " + decided.why + chain,
            "other nodes need it for " + needed.what, let_in(decided, packet)};
  return {judgement::warning,
          "whether " + port + " is open depends on " + decided.why + chain,
          "other nodes need it for " + needed.what
              + ", and the rule asks for more than port and protocol",
          "nft -a list chain " + decided.family + " " + decided.table + " "
              + decided.chain};
}

finding not_listed(const command_result& listed) {
  if (listed.code == command_not_found)
    return {judgement::skipped,
            "there is no program `nft` that lists its rules",
            {},
            "apt-get install nftables"};
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

std::vector<needed_packet> needed_packets(const examined_host& host) {
  const auto& config = host.config;
  const auto at = examined_address(host.interface, list_interfaces());
  const auto by = at ? at->name : std::string{};
  std::vector<needed_packet> result;
  const auto add = [&](const char* protocol, unsigned port, const char* what) {
    if (port != 0)
      result.push_back({{protocol, port, by}, what});
  };
  add("tcp", config.http_port, "requests and sessions");
  add("udp", config.http_port, "beats");
  add("udp", config.discovery_port, "the discovery server");
  add("udp", public_ports(config.public_domain_id).first,
      "finding the cells of a site");
  add("udp", ports_of_domain(config.ros_domain_id).first + first_skill_place,
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

findings examine_firewall(const examined_host& host) {
  return judge_firewall(
      run_bounded({host.nft, "-j", "list", "ruleset"}, nft_limit),
      needed_packets(host));
}

} // namespace roscell::cli
