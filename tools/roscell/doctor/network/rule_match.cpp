#include "tools/roscell/doctor/network/rule_match.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

namespace {

using named_sets = std::map<std::string, json>;

constexpr int deepest_set = 4;

rule_match from(bool is) {
  return is ? rule_match::yes : rule_match::no;
}

rule_match opposite(rule_match x) {
  return x == rule_match::maybe ? x : from(x == rule_match::no);
}

/// Whether one of some values fits.
template <class Fits>
rule_match any_of_values(const json& values, const Fits& fits) {
  auto result = rule_match::no;
  for (const auto& x : values)
    result = std::max(result, fits(x));
  return result;
}

/// Whether a number is among what a rule names: a number, a range, a set.
rule_match holds_number(const json& right, unsigned number,
                        const named_sets& sets, int depth = 0) {
  const auto within = [&](const json& x) {
    return holds_number(x, number, sets, depth + 1);
  };
  if (depth > deepest_set)
    return rule_match::maybe;
  if (right.is_number_integer())
    return from(right.get<int64_t>() == number);
  if (right.is_array())
    return any_of_values(right, within);
  if (right.is_string()) {
    const auto name = right.get<std::string>();
    const auto set =
        name.rfind('@', 0) == 0 ? sets.find(name.substr(1)) : sets.end();
    return set == sets.end() ? rule_match::maybe : within(set->second);
  }
  if (const auto set = right.find("set"); set != right.end())
    return within(*set);
  const auto range = right.find("range");
  const bool is_range = range != right.end() && range->is_array()
                        && range->size() == 2 && (*range)[0].is_number()
                        && (*range)[1].is_number();
  return is_range ? from((*range)[0].get<int64_t>() <= number
                         && number <= (*range)[1].get<int64_t>())
                  : rule_match::maybe;
}

/// Whether a word is among what a rule names; "eth*" stands for all that begin
/// so.
rule_match holds_word(const json& right, const std::string& word) {
  const auto within = [&](const json& x) { return holds_word(x, word); };
  if (right.is_array())
    return any_of_values(right, within);
  if (right.is_object() && right.contains("set"))
    return within(right["set"]);
  if (!right.is_string())
    return rule_match::maybe;
  const auto name = right.get<std::string>();
  if (!name.empty() && name.front() == '@')
    return rule_match::maybe;
  return from(!name.empty() && name.back() == '*'
                  ? word.rfind(name.substr(0, name.size() - 1), 0) == 0
                  : name == word);
}

std::string word_in(const json& object, const char* name) {
  const auto i = object.find(name);
  return i != object.end() && i->is_string() ? i->get<std::string>()
                                             : std::string{};
}

rule_match match_payload(const json& payload, const json& right,
                         const arriving_packet& packet,
                         const named_sets& sets) {
  const auto protocol = word_in(payload, "protocol");
  const auto field = word_in(payload, "field");
  constexpr const char* others[] = {"icmp", "icmpv6", "ip6", "arp", "sctp",
                                    "dccp", "esp",    "ah",  "igmp"};
  if ((protocol == "tcp" || protocol == "udp") && protocol != packet.protocol)
    return rule_match::no;
  if (std::find(std::begin(others), std::end(others), protocol)
      != std::end(others))
    return rule_match::no;
  if (field == "dport")
    return holds_number(right, packet.port, sets);
  if (protocol == "ip" && field == "protocol")
    return holds_word(right, packet.protocol);
  return rule_match::maybe;
}

rule_match match_meta(const std::string& key, const json& right,
                      const arriving_packet& packet) {
  if (key == "l4proto")
    return holds_word(right, packet.protocol);
  if (key == "nfproto")
    return holds_word(right, "ipv4");
  if ((key == "iifname" || key == "iif") && !packet.interface.empty())
    return holds_word(right, packet.interface);
  return rule_match::maybe;
}

rule_match match_left(const json& left, const json& right,
                      const arriving_packet& packet, const named_sets& sets);

/// Several things at once, each of which has to have its value.
rule_match match_parts(const json& left, const json& right,
                       const arriving_packet& packet, const named_sets& sets) {
  if (right.is_array() || right.contains("set"))
    return any_of_values(
        right.is_array() ? right : right["set"],
        [&](const json& x) { return match_parts(left, x, packet, sets); });
  const auto values = right.find("concat");
  if (values == right.end() || values->size() != left.size())
    return rule_match::maybe;
  auto result = rule_match::yes;
  for (size_t i = 0; i < left.size(); ++i)
    result = std::min(result, match_left(left[i], (*values)[i], packet, sets));
  return result;
}

/// What a rule asks for, without its operator.
rule_match match_left(const json& left, const json& right,
                      const arriving_packet& packet, const named_sets& sets) {
  if (!left.is_object())
    return rule_match::maybe;
  if (const auto parts = left.find("concat"); parts != left.end())
    return parts->is_array() ? match_parts(*parts, right, packet, sets)
                             : rule_match::maybe;
  if (const auto payload = left.find("payload"); payload != left.end())
    return match_payload(*payload, right, packet, sets);
  if (const auto meta = left.find("meta"); meta != left.end())
    return match_meta(word_in(*meta, "key"), right, packet);
  const auto ct = left.find("ct");
  return ct != left.end() && word_in(*ct, "key") == "state"
             ? holds_word(right, "new")
             : rule_match::maybe;
}

rule_match match_one(const json& match, const arriving_packet& packet,
                     const named_sets& sets) {
  const auto left = match.find("left");
  const auto right = match.find("right");
  if (left == match.end() || right == match.end())
    return rule_match::maybe;
  const auto result = match_left(*left, *right, packet, sets);
  const auto how = word_in(match, "op");
  // A rule of TCP's ports is for no UDP packet, whatever it asks of them.
  const bool other_protocol =
      left->contains("payload")
      && word_in((*left)["payload"], "field") == "dport"
      && word_in((*left)["payload"], "protocol") != "th"
      && word_in((*left)["payload"], "protocol") != packet.protocol;
  if (how == "==" || how == "in" || other_protocol)
    return result;
  return how == "!=" ? opposite(result) : rule_match::maybe;
}

/// Whether it asks for what cannot be known of a packet to come. Targets of
/// iptables ask for nothing, and its comments neither.
bool asks_for_more(const json& x) {
  if (const auto xt = x.find("xt"); xt != x.end())
    return word_in(*xt, "type") == "match" && word_in(*xt, "name") != "comment";
  return x.contains("limit") || x.contains("quota") || x.contains("ct count");
}

} // namespace

rule_match match_value(const json& left, const json& right,
                       const arriving_packet& packet, const named_sets& sets) {
  return match_left(left, right, packet, sets);
}

rule_match match_rule(const json& expressions, const arriving_packet& packet,
                      const named_sets& sets) {
  auto result = rule_match::yes;
  for (const auto& x : expressions) {
    if (!x.is_object())
      continue;
    if (const auto match = x.find("match"); match != x.end())
      result = std::min(result, match_one(*match, packet, sets));
    else if (asks_for_more(x))
      result = std::min(result, rule_match::maybe);
  }
  return result;
}

} // namespace roscell::cli
