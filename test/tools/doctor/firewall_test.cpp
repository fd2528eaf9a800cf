#include "tools/roscell/doctor/network/firewall.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

const needed_ports needed{{{8420, 8420}}, {{8420, 8420}, {7490, 7649}}};

/// A chain of `input`, and rules of its table.
json ruleset(const std::string& policy, const std::vector<std::string>& rules) {
  json result{{"nftables", json::array()}};
  result["nftables"].push_back({{"chain",
                                 {{"family", "inet"},
                                  {"table", "t"},
                                  {"name", "c"},
                                  {"hook", "input"},
                                  {"type", "filter"},
                                  {"policy", policy}}}});
  for (const auto& x : rules)
    result["nftables"].push_back({{"rule",
                                   {{"family", "inet"},
                                    {"table", "t"},
                                    {"chain", "c"},
                                    {"expr", json::parse(x)}}}});
  return result;
}

findings judge(const json& rules) {
  return judge_firewall(rules.dump(), needed);
}

} // namespace

TEST_CASE("rules that drop nothing are no firewall", "[doctor]") {
  CHECK(judge_firewall(std::string{R"({"nftables": []})"}, needed)[0].how
        == judgement::ok);
  CHECK(judge(ruleset("accept", {R"([{"accept": null}])"}))[0].how
        == judgement::ok);
}

TEST_CASE("a chain that may drop what arrives is told, with who can tell more",
          "[doctor]") {
  const auto by_policy = judge(ruleset("drop", {}));
  REQUIRE(by_policy.size() == 1);
  CHECK(by_policy[0].how == judgement::skipped);
  CHECK_THAT(by_policy[0].seen,
             Contains("(inet t c, policy drop)")
                 && Contains("`roscell doctor --cell` sends real packets"));
  for (const auto* rule :
       {R"([{"drop": null}])", R"([{"reject": {"type": "tcp reset"}}])",
        R"([{"xt": {"type": "target", "name": "REJECT"}}])",
        R"([{"vmap": {"key": {}, "data": {"set": [[22, {"drop": null}]]}}}])"})
    CHECK_THAT(judge(ruleset("accept", {rule}))[0].seen,
               Contains("(inet t c)"));
}

TEST_CASE("a chain of what leaves is no matter of other hosts", "[doctor]") {
  auto rules = ruleset("drop", {});
  rules["nftables"][0]["chain"]["hook"] = "output";
  CHECK(judge(rules)[0].how == judgement::ok);
}

TEST_CASE("who wrote the rules is told to let a node's packets in",
          "[doctor]") {
  auto rules = ruleset("drop", {});
  const auto remedy = [&] { return judge(rules)[0].remedy; };
  CHECK(remedy()
        == "sudo nft insert rule inet t c tcp dport '{ 8420 }' accept && sudo "
           "nft insert rule inet t c udp dport '{ 8420, 7490-7649 }' accept");
  rules["nftables"].push_back(json::parse(
      R"({"chain": {"family": "inet", "table": "t", "name": "ufw-user-input"}})"));
  CHECK(remedy()
        == "sudo ufw allow 8420/tcp && sudo ufw allow 8420,7490:7649/udp");
  rules["nftables"].erase(1);
  rules["nftables"][0]["chain"]["table"] = "firewalld";
  CHECK_THAT(remedy(), Contains("--add-port=8420/udp --add-port=7490-7649/udp "
                                "&& sudo firewall-cmd --reload"));
}

TEST_CASE("rules that nftables does not tell of are not taken for none",
          "[doctor]") {
  const auto found =
      judge_older_rules({{judgement::ok, "nothing drops"}}, "filter\n");
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::skipped);
  CHECK(judge_older_rules({{judgement::ok, "well"}}, "")[0].how
        == judgement::ok);
}

TEST_CASE("rules that cannot be listed are skipped with the reason",
          "[doctor]") {
  const auto judge_error = [](const char* message) {
    return judge_firewall(edge_error{error_code::engine_failed, message, ""},
                          needed)[0];
  };
  CHECK(
      judge_error("Operation not permitted (you must be root)\nnetlink: E").seen
      == "only root may list its rules");
  CHECK(judge_error("'/usr/bin/env' ended with code 127: env: 'nft'").remedy
        == "sudo apt-get install nftables");
  CHECK(judge_firewall(std::string{"no JSON"}, needed)[0].how
        == judgement::skipped);
  checked_host host;
  host.nft = "/nowhere/nft";
  host.proc = "/nowhere";
  CHECK_THAT(check_firewall(host)[0].seen, Contains("no program `nft`"));
}

TEST_CASE("a node needs the ports of its options and of its domains",
          "[doctor]") {
  checked_host host;
  host.config.http_port = 8420;
  host.config.discovery_port = 0;
  host.config.ros_domain_id = 1;
  const auto ports = ports_of_node(host);
  REQUIRE(ports.tcp.size() == 1);
  CHECK(ports.tcp[0].first == 8420);
  REQUIRE(ports.udp.size() == 3);
  CHECK(ports.udp[2].first == 7740);
  CHECK(ports.udp[2].last == 7899);
}
