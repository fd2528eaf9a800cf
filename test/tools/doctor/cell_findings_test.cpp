#include "tools/roscell/doctor/cell/cell_findings.hpp"
#include "tools/roscell/doctor/findings_view.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

namespace {

/// A coordinator, `head`, and two members, `arm` and `leg`.
reached_cell cell_of_three() {
  reached_cell result;
  result.coordinator = "head";
  int i = 1;
  for (const auto* name : {"head", "arm", "leg"}) {
    const auto ip = "10.0.0." + std::to_string(i++);
    result.nodes[name] = {name, "1.0", ip + ":8420", ip + ":11811", 7649, 0};
  }
  return result;
}

reach_report report_of(const std::string& from,
                       const std::vector<reach_row>& rows) {
  return {from, rows};
}

reach_row row_to(const std::string& node, reach_way way, port_answer answer) {
  return {node, way, uint16_t(way < reach_way::discovery ? 8420 : 7649), answer,
          answer == port_answer::found ? 0.5 : -1};
}

finding only_finding(const std::string& from, const reach_row& row) {
  const auto found = judge_reach(report_of(from, {row}), cell_of_three());
  REQUIRE(found.size() == 1);
  CHECK(found[0].check == "reach");
  CHECK(found[0].area == "cell");
  return found[0];
}

} // namespace

TEST_CASE("who is reached by all ways is told once", "[doctor]") {
  const auto found = judge_reach(
      report_of("arm", {row_to("head", reach_way::session, port_answer::found),
                        row_to("head", reach_way::data, port_answer::found),
                        row_to("leg", reach_way::data, port_answer::found)}),
      cell_of_three());
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::ok);
  CHECK_THAT(found[0].seen, Contains("arm reaches head, leg"));
}

TEST_CASE("what the coordinator and its members need of each other is broken "
          "without it",
          "[doctor]") {
  for (const auto way : {reach_way::session, reach_way::heartbeat,
                         reach_way::discovery, reach_way::data}) {
    CHECK(only_finding("arm", row_to("head", way, port_answer::silent)).how
          == judgement::broken);
    CHECK(only_finding("head", row_to("arm", way, port_answer::silent)).how
          == judgement::broken);
  }
}

TEST_CASE("members need each other's data, and nothing else now", "[doctor]") {
  for (const auto way :
       {reach_way::session, reach_way::heartbeat, reach_way::discovery})
    CHECK(only_finding("arm", row_to("leg", way, port_answer::silent)).how
          == judgement::warning);
  for (const auto way : {reach_way::data, reach_way::large})
    CHECK(only_finding("arm", row_to("leg", way, port_answer::silent)).how
          == judgement::broken);
  CHECK(only_finding("arm",
                     row_to("leg", reach_way::multicast, port_answer::silent))
            .how
        == judgement::warning);
}

TEST_CASE("what is in the way is told with the command that fixes it",
          "[doctor]") {
  auto x =
      only_finding("arm", row_to("leg", reach_way::data, port_answer::silent));
  CHECK(x.seen == "arm -> leg: data by udp port 7649: nothing comes back");
  CHECK(x.remedy
        == "ssh -t 10.0.0.3 'sudo nft insert rule inet filter input ip saddr "
           "10.0.0.2 udp dport 7400-7649 accept'");
  x = only_finding("arm",
                   row_to("head", reach_way::session, port_answer::silent));
  CHECK_THAT(x.remedy, Contains("10.0.0.1 'sudo"));
  CHECK_THAT(x.remedy, Contains("tcp dport 8420 accept"));
  x = only_finding("arm",
                   row_to("leg", reach_way::data, port_answer::unreachable));
  CHECK(x.remedy == "ssh -t 10.0.0.2 'ip route get 10.0.0.3'");
  x = only_finding("arm", row_to("leg", reach_way::large, port_answer::silent));
  CHECK(x.remedy == "ssh -t 10.0.0.2 'tracepath -n 10.0.0.3'");
}

TEST_CASE("what no data at all comes of is not told thrice", "[doctor]") {
  const auto found = judge_reach(
      report_of("arm",
                {row_to("leg", reach_way::data, port_answer::silent),
                 row_to("leg", reach_way::large, port_answer::silent),
                 row_to("leg", reach_way::multicast, port_answer::silent)}),
      cell_of_three());
  CHECK(found.size() == 1);
}

TEST_CASE("each end of the ports that skills have is told of, and once",
          "[doctor]") {
  auto low = row_to("leg", reach_way::data, port_answer::silent);
  low.port = 7491;
  const auto high = row_to("leg", reach_way::data, port_answer::found);
  auto found = judge_reach(report_of("arm", {high, low}), cell_of_three());
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].seen, Contains("arm -> leg: data by udp port 7491"));
  // Another program may have it, as long as it is not the node's own answer.
  low.answer = port_answer::closed;
  found = judge_reach(report_of("arm", {high, low}), cell_of_three());
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::ok);
  low.answer = port_answer::silent;
  const auto both = row_to("leg", reach_way::data, port_answer::silent);
  CHECK(judge_reach(report_of("arm", {both, low}), cell_of_three()).size()
        == 1);
}

TEST_CASE("clocks are told when they differ for sure", "[doctor]") {
  const auto cell = cell_of_three();
  auto found = judge_clocks(
      {{"head", 5000, 1}, {"arm", 5010, 2}, {"leg", 4900, 200}}, cell);
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::ok);
  found =
      judge_clocks({{"head", 0, 1}, {"arm", 100, 2}, {"leg", -90000, 2}}, cell);
  REQUIRE(found.size() == 2);
  CHECK(found[0].how == judgement::warning);
  CHECK_THAT(found[0].seen, Contains("arm's clock is 0.1 s ahead of"));
  CHECK(found[1].how == judgement::broken);
  CHECK_THAT(found[1].seen, Contains("leg's clock is 90 s behind"));
}

TEST_CASE("a coordinator whose clock alone is wrong is told, and nobody else",
          "[doctor]") {
  const auto cell = cell_of_three();
  const auto found = judge_clocks(
      {{"arm", 90000, 2}, {"head", 0, 1}, {"leg", 90010, 2}}, cell);
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::broken);
  CHECK_THAT(found[0].seen,
             Contains("head's clock is 90 s behind that of most nodes"));
  // Where no two agree the coordinator's is as good as any other.
  const auto apart =
      judge_clocks({{"arm", 90000, 2}, {"head", 0, 1}, {"leg", 5000, 2}}, cell);
  REQUIRE(apart.size() == 2);
  CHECK_THAT(apart[0].seen, Contains("arm's clock is 90 s ahead of the coord"));
}

TEST_CASE("a node of another version than the coordinator's is a warning",
          "[doctor]") {
  auto cell = cell_of_three();
  CHECK(judge_versions(cell).at(0).how == judgement::ok);
  cell.nodes["leg"].version = "0.9";
  const auto found = judge_versions(cell);
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::warning);
  CHECK(found[0].seen == "leg is of version 0.9, its coordinator of 1.0");
}

TEST_CASE("what other hosts have found is told in numbers, and what is wrong "
          "by name",
          "[doctor]") {
  finding small{judgement::warning, "eth0 has an MTU of 1280", "slow", "mend"};
  small.check = "mtu";
  small.area = "network";
  small.node = "leg";
  auto fine = small;
  fine.how = judgement::ok;
  const auto text = findings_view({small, fine}, {}, false);
  CHECK_THAT(text, Contains("HOST"));
  CHECK_THAT(text, Contains("leg: mtu: eth0 has an MTU of 1280"));
  CHECK_THAT(text, !Contains("NETWORK"));
}

TEST_CASE("nothing that another host tells controls the terminal", "[doctor]") {
  const std::string erase = "\x1b[2J";
  finding x{judgement::warning, erase, erase, erase};
  x.check = x.area = x.node = erase;
  CHECK_THAT(findings_view({x}, {}, false), !Contains("\x1b"));
  x.node.clear();
  x.area = "host";
  CHECK_THAT(findings_view({x}, {}, false), !Contains("\x1b"));
}

TEST_CASE("a command of many files is had from the doctor again", "[doctor]") {
  finding many{judgement::warning, "900 files", "room", "rm -f "};
  many.check = "leftovers";
  many.area = "host";
  for (int i = 0; i < 900; ++i)
    many.remedy += "/dev/shm/x" + std::to_string(i) + " ";
  const auto text = findings_view({many}, {}, false);
  CHECK_THAT(text, Contains("roscell doctor -o json --only leftovers | jq"));
  CHECK(text.size() < 1000);
  CHECK_THAT(findings_view({many}, {}, false, "roscell doctor --to /a/b"),
             Contains("$ roscell doctor --to /a/b -o json --only leftovers"));
}
