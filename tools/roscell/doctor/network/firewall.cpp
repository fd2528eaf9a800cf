#include "tools/roscell/doctor/network/firewall.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds nft_limit{3};

/// Ten thousand rules take less.
constexpr size_t most_listed_bytes = 16UL << 20;

/// Where skills begin to look for a free port
/// (skills/ros2/participant_qos.cpp).
constexpr unsigned first_skill_place = 90;

/// A chain that the kernel begins with, as `nft -j list ruleset` names it.
struct packet_filter {
  std::string family, table, chain;
  bool closed = false; ///< Its policy drops what no rule lets in.
};

std::string text_at(const json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>()
                                             : std::string{};
}

/// Whether something of a rule or a map may take a packet away.
bool may_drop(const json& x) {
  const auto text = x.dump();
  const char* verdicts[] = {"\"drop\"", "\"reject\"", "\"REJECT\""};
  return std::any_of(
      std::begin(verdicts), std::end(verdicts),
      [&](auto* verdict) { return text.find(verdict) != text.npos; });
}

bool takes_arriving(const json& chain) {
  const auto family = text_at(chain, "family");
  const auto hook = text_at(chain, "hook");
  return (family == "ip" || family == "inet")
         && text_at(chain, "type") == "filter"
         && (hook == "input" || hook == "prerouting");
}

/// Calls for each object of a ruleset with its kind, itself and its table.
template <class Visit>
void for_each_object(const json& ruleset, const Visit& visit) {
  for (const auto& x : ruleset.value("nftables", json::array()))
    if (x.is_object() && !x.empty() && x.begin()->is_object())
      visit(x.begin().key(), *x.begin(),
            text_at(*x.begin(), "family") + " " + text_at(*x.begin(), "table"));
}

std::vector<packet_filter> filters_in(const json& ruleset) {
  std::set<std::string> dropping;
  for_each_object(ruleset, [&](auto& kind, auto& what, const auto& table) {
    if ((kind == "rule" || kind == "map") && may_drop(what))
      dropping.insert(table);
  });
  std::vector<packet_filter> result;
  for_each_object(ruleset, [&](auto& kind, auto& what, const auto& table) {
    const bool closed = text_at(what, "policy") == "drop";
    if (kind == "chain" && takes_arriving(what)
        && (closed || dropping.count(table) != 0))
      result.push_back({text_at(what, "family"), text_at(what, "table"),
                        text_at(what, "name"), closed});
  });
  return result;
}

/// Whether ufw has written rules of a table: its chains have names of its own.
bool is_of_ufw(const json& ruleset, const packet_filter& filter) {
  bool result = false;
  for_each_object(ruleset, [&](auto& kind, auto& what, const auto& table) {
    result = result
             || (kind == "chain" && table == filter.family + " " + filter.table
                 && text_at(what, "name").rfind("ufw-", 0) == 0);
  });
  return result;
}

/// "8420, 7490-7649"
std::string ports_text(const std::vector<port_range>& all, const char* to,
                       const std::string& separator = ", ") {
  std::vector<std::string> texts;
  texts.reserve(all.size());
  for (const auto& x : all)
    texts.push_back(std::to_string(x.first)
                    + (x.last > x.first ? to + std::to_string(x.last) : ""));
  return joined(texts, separator);
}

/// The command that lets packets to these ports in, in the words of who wrote
/// the rules.
std::string let_in(const packet_filter& filter, bool by_ufw,
                   const char* protocol, const std::vector<port_range>& ports) {
  if (by_ufw)
    return "sudo ufw allow " + ports_text(ports, ":", ",") + "/" + protocol;
  const auto of_protocol = std::string{"/"} + protocol;
  if (filter.table == "firewalld")
    return "sudo firewall-cmd --permanent --add-port="
           + ports_text(ports, "-", of_protocol + " --add-port=") + of_protocol
           + " && sudo firewall-cmd --reload";
  return "sudo nft insert rule " + shell_word(filter.family) + " "
         + shell_word(filter.table) + " " + shell_word(filter.chain) + " "
         + protocol + " dport "
         + shell_word("{ " + ports_text(ports, "-") + " }") + " accept";
}

finding judge_filter(const packet_filter& filter, bool by_ufw,
                     const needed_ports& needed) {
  std::vector<std::string> commands, names;
  for (const auto& [protocol, ports] :
       {std::pair{"tcp", needed.tcp}, std::pair{"udp", needed.udp}})
    if (!ports.empty()) {
      names.push_back(std::string{protocol} + " " + ports_text(ports, "-"));
      commands.push_back(let_in(filter, by_ufw, protocol, ports));
    }
  return {judgement::skipped,
          "nftables filters what arrives (" + filter.family + " " + filter.table
              + " " + filter.chain + (filter.closed ? ", policy drop" : "")
              + "); `roscell doctor --cell` sends real packets",
          "other nodes need " + joined(names, " and ")
              + "; the command lets them in",
          joined(commands, " && ")};
}

finding not_listed(const std::string& why) {
  const auto has = [&](const char* text) {
    return why.find(text) != std::string::npos;
  };
  if (has("ended with code 127"))
    return {judgement::skipped,
            "there is no program `nft` that lists its rules",
            {},
            "sudo apt-get install nftables"};
  if (has("Operation not permitted"))
    return {judgement::skipped,
            "only root may list its rules",
            {},
            "sudo roscell doctor --only firewall"};
  return {judgement::skipped,
          "`nft -j list ruleset`: " + why.substr(0, why.find('\n'))};
}

edge_result<std::string> list_rules(const std::string& nft) {
  const auto* path = std::getenv("PATH");
  return run_program({"/usr/bin/env",
                      {nft, "-j", "list", "ruleset"},
                      {{"LC_ALL", "C"}, {"PATH", path == nullptr ? "" : path}}},
                     nft_limit, most_listed_bytes);
}

} // namespace

needed_ports ports_of_node(const checked_host& host) {
  const auto& config = host.config;
  const auto skills = ports_of_domain(config.ros_domain_id);
  needed_ports result;
  if (config.http_port != 0)
    result.tcp = result.udp = {{config.http_port, config.http_port}};
  if (config.discovery_port != 0)
    result.udp.push_back({config.discovery_port, config.discovery_port});
  result.udp.push_back(public_ports(config.public_domain_id));
  result.udp.push_back({skills.first + first_skill_place, skills.last});
  return result;
}

findings judge_firewall(const edge_result<std::string>& listed,
                        const needed_ports& needed) {
  if (const auto* why = std::get_if<edge_error>(&listed))
    return {not_listed(why->message)};
  const auto rules = json::parse(std::get<std::string>(listed), nullptr, false);
  if (!rules.is_object())
    return {not_listed("it gives no JSON")};
  findings result;
  for (const auto& x : filters_in(rules))
    result.push_back(judge_filter(x, is_of_ufw(rules, x), needed));
  if (result.empty())
    result.push_back({judgement::ok, "no rule of nftables drops what arrives"});
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
      judge_firewall(list_rules(host.nft), ports_of_node(host)),
      read_small_file(host.proc + "/net/ip_tables_names", most_names)
          .value_or(""));
}

} // namespace roscell::cli
