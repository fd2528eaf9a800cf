#include "tools/roscell/doctor/network/firewall.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

const arriving_packet heartbeat{"udp", 8420, "eth0"};

/// A chain of input with these rules, each the list of its expressions.
json ruleset(const char* policy, const std::vector<const char*>& rules) {
  auto list = json::array();
  list.push_back({{"chain",
                   {{"family", "inet"},
                    {"table", "t"},
                    {"name", "c"},
                    {"type", "filter"},
                    {"hook", "input"},
                    {"policy", policy}}}});
  int handle = 1;
  for (const auto* text : rules)
    list.push_back({{"rule",
                     {{"family", "inet"},
                      {"table", "t"},
                      {"chain", "c"},
                      {"handle", ++handle},
                      {"expr", json::parse(text)}}}});
  return {{"nftables", list}};
}

packet_fate fate_of(const char* policy, const std::vector<const char*>& rules) {
  return judge_packet(ruleset(policy, rules), heartbeat).fate;
}

constexpr auto tcp_ports =
    R"([{"match": {"op": "==", "left": {"payload": {"protocol": "tcp",
      "field": "dport"}}, "right": 8420}}, {"accept": null}])";
constexpr auto our_range =
    R"([{"match": {"op": "==", "left": {"payload": {"protocol": "udp",
      "field": "dport"}}, "right": {"set": [22, {"range": [8000, 9000]}]}}},
      {"accept": null}])";
constexpr auto all_but_ours =
    R"([{"match": {"op": "!=", "left": {"payload": {"protocol": "udp",
      "field": "dport"}}, "right": 8420}}, {"drop": null}])";
constexpr auto all_but_one_of_tcp =
    R"([{"match": {"op": "!=", "left": {"payload": {"protocol": "tcp",
      "field": "dport"}}, "right": 22}}, {"drop": null}])";
constexpr auto established =
    R"([{"match": {"op": "in", "left": {"ct": {"key": "state"}},
      "right": ["established", "related"]}}, {"accept": null}])";
constexpr auto one_sender =
    R"([{"match": {"op": "==", "left": {"payload": {"protocol": "ip",
      "field": "saddr"}}, "right": "10.0.0.1"}}, {"accept": null}])";
constexpr auto by_eth =
    R"([{"match": {"op": "==", "left": {"meta": {"key": "iifname"}},
      "right": "eth*"}}, {"accept": null}])";
constexpr auto by_loopback =
    R"([{"match": {"op": "==", "left": {"meta": {"key": "iifname"}},
      "right": "lo"}}, {"accept": null}])";
constexpr auto drop_all = R"([{"counter": null}, {"drop": null}])";
constexpr auto drop_some = R"([{"limit": {"rate": 5}}, {"drop": null}])";
constexpr auto drop_a_few =
    R"([{"match": {"op": "<", "left": {"numgen": {"mode": "random", "mod": 100}},
      "right": 5}}, {"drop": null}])";

constexpr auto ports_map =
    R"([{"vmap": {"key": {"payload": {"protocol": "udp", "field": "dport"}},
      "data": {"set": [["*", {"drop": null}], [22, {"drop": null}],
        [{"range": [8000, 9000]}, {"accept": null}]]}}}])";
constexpr auto state_map =
    R"([{"vmap": {"key": {"ct": {"key": "state"}},
      "data": {"set": [["invalid", {"drop": null}],
        ["established", {"accept": null}], ["related", {"accept": null}]]}}}])";
constexpr auto pairs_map =
    R"([{"vmap": {"key": {"concat": [{"meta": {"key": "l4proto"}},
        {"payload": {"protocol": "th", "field": "dport"}}]},
      "data": {"set": [[{"concat": ["tcp", 22]}, {"accept": null}],
        [{"concat": ["udp", 8420]}, {"accept": null}]]}}}])";
constexpr auto senders_map =
    R"([{"vmap": {"key": {"payload": {"protocol": "ip", "field": "saddr"}},
      "data": {"set": [["10.0.0.1", {"accept": null}]]}}}])";

} // namespace

TEST_CASE("without rules every packet is let in", "[doctor]") {
  CHECK(judge_packet(json::parse(R"({"nftables": []})"), heartbeat).fate
        == packet_fate::accepted);
  CHECK(fate_of("accept", {}) == packet_fate::accepted);
}

TEST_CASE("a policy decides where no rule does", "[doctor]") {
  CHECK(fate_of("drop", {}) == packet_fate::dropped);
  CHECK(fate_of("drop", {tcp_ports, established, by_loopback})
        == packet_fate::dropped);
  const auto verdict = judge_packet(ruleset("drop", {}), heartbeat);
  CHECK(verdict.why == "the policy of the chain");
  CHECK(verdict.chain == "c");
}

TEST_CASE("the first rule that is for a packet decides", "[doctor]") {
  CHECK(fate_of("drop", {our_range}) == packet_fate::accepted);
  CHECK(fate_of("drop", {by_eth}) == packet_fate::accepted);
  CHECK(fate_of("drop", {drop_all, our_range}) == packet_fate::dropped);
  CHECK(fate_of("accept", {all_but_ours}) == packet_fate::accepted);
  CHECK(judge_packet(ruleset("accept", {our_range, drop_all}),
                     {"udp", 11811, "eth0"})
            .why
        == "rule 3 of chain c");
}

TEST_CASE("a rule of TCP's ports is for no other packet", "[doctor]") {
  CHECK(fate_of("accept", {all_but_one_of_tcp}) == packet_fate::accepted);
}

TEST_CASE("a rule that asks for more is not guessed at", "[doctor]") {
  CHECK(fate_of("drop", {one_sender}) == packet_fate::depends);
  CHECK(fate_of("accept", {drop_some}) == packet_fate::depends);
  CHECK(fate_of("accept", {drop_a_few}) == packet_fate::depends);
  CHECK(fate_of("drop", {one_sender, our_range}) == packet_fate::accepted);
}

TEST_CASE("a set is looked into, and a chain that is jumped to", "[doctor]") {
  auto rules = ruleset(
      "drop",
      {
          R"([{"match": {"op": "==", "left": {"payload": {"protocol": "th",
        "field": "dport"}}, "right": "@open"}}, {"jump": {"target": "more"}}])"});
  rules["nftables"].push_back({{"set",
                                {{"family", "inet"},
                                 {"table", "t"},
                                 {"name", "open"},
                                 {"elem", {22, 8420}}}}});
  rules["nftables"].push_back(
      {{"rule",
        {{"family", "inet"},
         {"table", "t"},
         {"chain", "more"},
         {"handle", 9},
         {"expr", json::parse(R"([{"accept": null}])")}}}});
  CHECK(judge_packet(rules, heartbeat).fate == packet_fate::accepted);
  CHECK(judge_packet(rules, {"udp", 8421, "eth0"}).fate
        == packet_fate::dropped);
}

TEST_CASE("a map gives each packet its own verdict", "[doctor]") {
  CHECK(fate_of("drop", {ports_map}) == packet_fate::accepted);
  CHECK(judge_packet(ruleset("accept", {ports_map}), {"udp", 9, "eth0"}).fate
        == packet_fate::dropped);
  CHECK(judge_packet(ruleset("accept", {ports_map}), {"tcp", 9, "eth0"}).fate
        == packet_fate::accepted);
  CHECK(fate_of("accept", {state_map}) == packet_fate::accepted);
  CHECK(fate_of("drop", {state_map}) == packet_fate::dropped);
  CHECK(fate_of("drop", {pairs_map}) == packet_fate::accepted);
  CHECK(judge_packet(ruleset("drop", {pairs_map}), {"tcp", 8420, "eth0"}).fate
        == packet_fate::dropped);
}

TEST_CASE("a map that asks for more is not guessed at", "[doctor]") {
  CHECK(fate_of("drop", {senders_map}) == packet_fate::depends);
  CHECK(fate_of("accept", {senders_map}) == packet_fate::accepted);
}

TEST_CASE("a map that has a name is looked into, and its chains", "[doctor]") {
  auto rules = ruleset("drop", {R"([{"vmap": {
    "key": {"meta": {"key": "iifname"}}, "data": "@doors"}}])"});
  rules["nftables"].push_back(json::parse(
      R"({"map": {"family": "inet", "table": "t", "name": "doors",
        "map": "verdict", "elem": [["lo", {"accept": null}],
          ["eth0", {"goto": {"target": "hall"}}]]}})"));
  rules["nftables"].push_back(json::parse(
      R"({"rule": {"family": "inet", "table": "t", "chain": "hall",
        "handle": 9, "expr": [{"accept": null}]}})"));
  CHECK(judge_packet(rules, heartbeat).fate == packet_fate::accepted);
  CHECK(judge_packet(rules, {"udp", 8420, "eth1"}).fate
        == packet_fate::dropped);
}

TEST_CASE("who wrote the rules is told to change them", "[doctor]") {
  const needed_packet skills{{"udp", 7490, "eth0"}, 7649, "topics"};
  auto rules = ruleset("drop", {});
  const auto remedy = [&] {
    return judge_firewall({0, rules.dump()}, {skills})[0].remedy;
  };
  CHECK(remedy() == "sudo nft insert rule inet t c udp dport 7490-7649 accept");
  rules["nftables"].push_back(json::parse(
      R"({"chain": {"family": "inet", "table": "t", "name": "ufw-user-input"}})"));
  CHECK(remedy() == "sudo ufw allow 7490:7649/udp");
  for (auto& x : rules["nftables"])
    x.begin().value()["table"] = "firewalld";
  CHECK(remedy()
        == "sudo firewall-cmd --permanent --add-port=7490-7649/udp && sudo "
           "firewall-cmd --reload");
}

TEST_CASE("rules that nftables does not tell of are not taken for none",
          "[doctor]") {
  const auto found =
      judge_older_rules({{judgement::ok, "nftables lets in"}}, "filter\n");
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::skipped);
  CHECK(judge_older_rules({{judgement::ok, "well"}}, "")[0].how
        == judgement::ok);
  CHECK(judge_older_rules({{judgement::broken, "closed"}}, "filter").size()
        == 2);
}

TEST_CASE("a port that is closed is told with the command that opens it",
          "[doctor]") {
  const command_result listed{0, ruleset("drop", {tcp_ports}).dump()};
  const auto found =
      judge_firewall(listed, {{{"tcp", 8420, "eth0"}, 8420, "requests"},
                              {heartbeat, 8420, "heartbeats"}});
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::broken);
  CHECK(found[0].remedy
        == "sudo nft insert rule inet t c udp dport 8420 accept");
}

TEST_CASE("rules that cannot be listed are skipped with the reason",
          "[doctor]") {
  const auto found = judge_firewall(
      {1, "Operation not permitted (you must be root)\nnetlink: Error\n"}, {});
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::skipped);
  CHECK(found[0].seen == "only root may list its rules");
  CHECK(judge_firewall({command_not_found, ""}, {})[0].how
        == judgement::skipped);
  CHECK(judge_firewall({0, "no JSON"}, {})[0].how == judgement::skipped);
}
