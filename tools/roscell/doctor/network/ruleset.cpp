#include "tools/roscell/doctor/network/ruleset.hpp"

#include "tools/roscell/doctor/network/rule_match.hpp"

#include <map>
#include <optional>
#include <vector>

namespace roscell::cli {

namespace {

/// A chain of rules with what they need to be gone through.
struct rule_chain {
  std::string family, table, name, hook, policy, type;
  std::vector<json> rules;
};

struct firewall_table {
  std::map<std::string, rule_chain> chains; ///< By name.
  std::map<std::string, json> sets;         ///< Their elements, by name.
  std::map<std::string, json> maps;         ///< To verdicts, likewise.
};

std::string text_at(const json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>()
                                             : std::string{};
}

bool is_reject_of_iptables(const json& x) {
  const auto xt = x.find("xt");
  return xt != x.end() && text_at(*xt, "name") == "REJECT";
}

/// By family and name.
std::map<std::string, firewall_table> tables_in(const json& ruleset) {
  std::map<std::string, firewall_table> result;
  const auto list = ruleset.is_object()
                        ? ruleset.value("nftables", json::array())
                        : json::array();
  for (const auto& x : list) {
    if (!x.is_object() || x.empty() || !x.begin()->is_object())
      continue;
    const auto& kind = x.begin().key();
    const auto& what = *x.begin();
    auto& table =
        result[text_at(what, "family") + " " + text_at(what, "table")];
    if (kind == "chain")
      table.chains[text_at(what, "name")] = {text_at(what, "family"),
                                             text_at(what, "table"),
                                             text_at(what, "name"),
                                             text_at(what, "hook"),
                                             text_at(what, "policy"),
                                             text_at(what, "type"),
                                             {}};
    else if (kind == "rule")
      table.chains[text_at(what, "chain")].rules.push_back(what);
    else if (kind == "set")
      table.sets[text_at(what, "name")] = what.value("elem", json::array());
    else if (kind == "map")
      table.maps[text_at(what, "name")] = what.value("elem", json::array());
  }
  return result;
}

/// One packet on its way through the chains of a table.
class passage {
public:
  passage(const firewall_table& table, const arriving_packet& packet)
      : table_{table}, packet_{packet} {}

  packet_verdict through(const rule_chain& base) {
    auto end = walk(base, 0);
    if (!end && base.policy == "drop")
      end = {false, "the policy of the chain"};
    packet_verdict result{packet_fate::accepted,
                          base.family,
                          base.table,
                          base.name,
                          "",
                          is_of_ufw()};
    const bool passes = !end || end->passes;
    const auto& doubt = passes ? may_drop_ : may_pass_;
    if (!doubt.empty())
      result.fate = packet_fate::depends;
    else if (!passes)
      result.fate = packet_fate::dropped;
    result.why = passes || !doubt.empty() ? doubt : end->why;
    return result;
  }

private:
  struct ending {
    bool passes;
    std::string why;
  };

  static constexpr int deepest_jump = 16;

  bool is_of_ufw() const {
    const auto chain = table_.chains.lower_bound("ufw-");
    return chain != table_.chains.end() && chain->first.rfind("ufw-", 0) == 0;
  }

  /// What becomes of a packet by one statement; nothing: it goes on.
  std::optional<ending> obey(const json& x, const std::string& name, int depth,
                             bool& leaves) {
    if (x.contains("accept"))
      return ending{true, name};
    if (x.contains("drop") || x.contains("reject") || is_reject_of_iptables(x))
      return ending{false, name};
    leaves = leaves || x.contains("return") || x.contains("goto");
    if (const auto map = x.find("vmap"); map != x.end())
      return look_up(*map, name, depth, leaves);
    for (const auto* way : {"jump", "goto"})
      if (const auto to = x.find(way); to != x.end())
        if (const auto next = table_.chains.find(text_at(*to, "target"));
            next != table_.chains.end() && depth < deepest_jump)
          return walk(next->second, depth + 1);
    return std::nullopt;
  }

  /// The pairs of value and verdict that a rule names, or has in itself.
  json pairs_of(const json& map) const {
    const auto data = map.value("data", json{});
    if (data.is_object())
      return data.value("set", json::array());
    const auto name = data.is_string() ? data.get<std::string>() : "";
    const auto known = table_.maps.find(name.substr(name.empty() ? 0 : 1));
    return known == table_.maps.end() ? json{} : known->second;
  }

  /// The verdict of a map for the packet; one that only may be meant is noted.
  std::optional<ending> look_up(const json& map, const std::string& name,
                                int depth, bool& leaves) {
    const auto key = map.value("key", json{});
    json for_others; // Of all values that the map does not name.
    for (const auto& x : pairs_of(map)) {
      if (!x.is_array() || x.size() != 2 || !x[1].is_object())
        continue;
      const auto fits = match_value(key, x[0], packet_, table_.sets);
      if (fits == rule_match::no)
        continue;
      if (x[0] == "*")
        for_others = x[1];
      else if (fits == rule_match::yes)
        return obey(x[1], name, depth, leaves);
      else if (bool left = false; auto end = obey(x[1], name, depth, left))
        note(*end);
    }
    return for_others.is_object() ? obey(for_others, name, depth, leaves)
                                  : std::nullopt;
  }

  /// What the rule does with a packet that it is for; nothing: it goes on.
  std::optional<ending> act(const json& rule, const std::string& name,
                            int depth, bool& leaves) {
    for (const auto& x : rule.value("expr", json::array()))
      if (x.is_object())
        if (auto end = obey(x, name, depth, leaves))
          return end;
    return std::nullopt;
  }

  /// Something that may happen to a packet.
  void note(const ending& end) {
    (end.passes ? may_pass_ : may_drop_) = end.why;
  }

  std::optional<ending> walk(const rule_chain& chain, int depth) {
    for (const auto& rule : chain.rules) {
      const auto fits =
          match_rule(rule.value("expr", json::array()), packet_, table_.sets);
      if (fits == rule_match::no)
        continue;
      bool leaves = false;
      const auto name = "rule " + std::to_string(rule.value("handle", 0))
                        + " of chain " + chain.name;
      auto end = act(rule, name, depth, leaves);
      if (end && fits == rule_match::yes)
        return end;
      if (end)
        note(*end);
      else if (leaves && fits == rule_match::yes)
        return std::nullopt;
    }
    return std::nullopt;
  }

  const firewall_table& table_;
  const arriving_packet& packet_;
  std::string may_pass_; ///< The rule that lets some through.
  std::string may_drop_; ///< The rule that takes some away.
};

bool is_asked(const rule_chain& chain) {
  const bool family = chain.family == "ip" || chain.family == "inet";
  return family && chain.type == "filter"
         && (chain.hook == "input" || chain.hook == "prerouting");
}

} // namespace

packet_verdict judge_packet(const json& ruleset,
                            const arriving_packet& packet) {
  packet_verdict worst;
  for (const auto& [name, table] : tables_in(ruleset))
    for (const auto& [chain_name, chain] : table.chains) {
      if (!is_asked(chain))
        continue;
      auto one = passage{table, packet}.through(chain);
      if (one.fate == packet_fate::dropped)
        return one;
      if (one.fate == packet_fate::depends)
        worst = one;
    }
  return worst;
}

} // namespace roscell::cli
