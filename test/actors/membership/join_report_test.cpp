#include "actors/membership/join_report.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace roscell;

namespace {

using namespace std::chrono_literals;

const join_report::time_point start{100s};

} // namespace

TEST_CASE("attempts are counted from the last time in a cell") {
  join_report report;
  CHECK(report.rows().empty());
  report.begin("10.0.0.1:11811", 1000);
  report.begin("10.0.0.1:11811", 7000);
  REQUIRE(report.rows().size() == 1);
  CHECK(report.rows()[0].attempts == 2);
  CHECK(report.rows()[0].tried_unix_ms == 7000);
  report.clear();
  CHECK(report.rows().empty());
  report.begin("10.0.0.1:11811", 9000);
  CHECK(report.rows()[0].attempts == 1);
}

TEST_CASE("the same problem is told again after ever longer pauses") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  int reported = 0;
  for (auto passed = 0s; passed < 24h; passed += 30s)
    reported +=
        report.note("nothing listens there", "", start + passed) ? 1 : 0;
  // After 1, 2, 4, ... minutes, then every half an hour.
  CHECK(reported >= 48);
  CHECK(reported <= 54);
}

TEST_CASE("another problem is told at once, but not ever new ones") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  CHECK(report.note("nothing listens there", "", start));
  CHECK(report.note("a firewall drops UDP", "open it", start + 1s));
  CHECK(report.rows()[0].problem == "a firewall drops UDP");
  CHECK(report.rows()[0].hint == "open it");
  CHECK_FALSE(report.note("nothing listens there", "", start + 2s));
  int reported = 0;
  for (int i = 0; i < 100; ++i)
    reported +=
        report.note("trouble " + std::to_string(i), "", start + 3s) ? 1 : 0;
  CHECK(reported < 10);
  CHECK(report.rows()[0].problem == "trouble 99");
}

TEST_CASE("problem at one address is not shown of another") {
  join_report report;
  report.begin("10.0.0.1:11811", 0);
  report.note("nothing listens there", "start it", start);
  report.begin("10.0.0.2:11811", 0);
  CHECK(report.rows()[0].address == "10.0.0.2:11811");
  CHECK(report.rows()[0].problem.empty());
  CHECK(report.rows()[0].hint.empty());
}

TEST_CASE("nothing is told of who does not try") {
  join_report report;
  CHECK_FALSE(report.note("nothing listens there", "", start));
}

namespace {

using Catch::Matchers::Contains;

node_hello coordinator(const std::string& discovery_server = "10.0.0.1:11811") {
  node_hello result;
  result.node = "head";
  result.role = node_role::coordinator;
  result.state = node_state::member;
  result.cell = "lab";
  result.coordinator = "10.0.0.1:8420";
  result.discovery_server = discovery_server;
  return result;
}

node_hello member() {
  auto result = coordinator();
  result.node = "arm-1";
  result.role = node_role::primary;
  return result;
}

node_hello loner() {
  node_hello result;
  result.node = "arm-2";
  return result;
}

/// What the join diagnoser has found: the UDP port, the TCP port of the same
/// number, and the usual HTTP port.
server_probed sight(port_answer udp, port_answer same, port_answer usual) {
  return {udp, {{11811, same, {}}, {8420, usual, {}}}};
}

server_probed sight(port_answer udp, const node_hello& who) {
  return {
      udp,
      {{11811, port_answer::closed, {}}, {8420, port_answer::found, {who}}}};
}

struct row {
  const char* what;
  server_probed found;
  const char* problem;
  const char* hint;
};

using answer = port_answer;

const std::vector<row> rows{
    {"nothing listens there",
     sight(answer::closed, answer::closed, answer::closed),
     "nothing listens on UDP port 11811 of base.local, nor on TCP ports 11811 "
     "and 8420",
     "is the coordinator running there?"},
    {"UDP is silent, TCP is closed",
     sight(answer::silent, answer::closed, answer::closed),
     "UDP port 11811 of base.local does not answer, and nothing listens on "
     "TCP ports",
     "--discovery-port"},
    {"the host is down, or drops everything",
     sight(answer::silent, answer::silent, answer::silent),
     "base.local does not answer at all", "is that host up?"},
    {"there is no route",
     sight(answer::unreachable, answer::unreachable, answer::unreachable),
     "there is no way to base.local", "--interface"},
    {"a firewall drops UDP only", sight(answer::silent, coordinator()),
     "coordinator 'head' of cell 'lab' answers on TCP port 8420 of base.local, "
     "but its discovery server does not answer on UDP port 11811: a firewall "
     "drops UDP",
     "let UDP port 11811 and its answers through"},
    {"a firewall rejects UDP only", sight(answer::closed, coordinator()),
     "a firewall rejects UDP", "let UDP port 11811 through on base.local"},
    {"the discovery server is at another port",
     sight(answer::closed, coordinator("10.0.0.1:12000")),
     "has its discovery server on UDP port 12000, not on 11811",
     "use --join 10.0.0.1:12000"},
    {"a member is no coordinator", sight(answer::closed, member()),
     "node 'arm-1' at base.local is a member of cell 'lab', not its "
     "coordinator, which is at 10.0.0.1:8420",
     "use --join 10.0.0.1:11811"},
    {"a node in no cell is no coordinator", sight(answer::closed, loner()),
     "node 'arm-2' at base.local is in no cell, and coordinates none",
     "--coordinator"},
    {"a discovery server of ROS 2 alone",
     sight(answer::found, answer::closed, answer::closed),
     "but no coordinator of ROSCell announces itself there", "ROS 2 alone"},
    {"DDS without a well-known prefix",
     sight(answer::unauthenticated_peer, answer::closed, answer::closed),
     "no discovery server that ROS 2 knows", "coordinator of ROSCell"},
    {"a web server",
     sight(answer::closed, answer::closed, answer::unauthenticated_peer),
     "what listens on TCP port 8420 is no node of ROSCell",
     "coordinator of ROSCell"},
    {"what the server announces does not arrive",
     sight(answer::found, coordinator()),
     "answers on UDP port 11811, but what it announces does not arrive",
     "in both directions"},
};

} // namespace

TEST_CASE("each cause of a failed join has its own words and remedy") {
  for (const auto& x : rows) {
    INFO(x.what);
    const auto said = diagnose({"base.local:11811", 11811}, x.found);
    CHECK_THAT(said.problem, Contains(x.problem));
    CHECK_THAT(said.hint, Contains(x.hint));
  }
}

TEST_CASE("who gives the HTTP port is told the discovery port") {
  const server_probed found{port_answer::silent,
                            {{8420, port_answer::found, {coordinator()}}}};
  const auto said = diagnose({"10.0.0.1:8420", 8420}, found);
  CHECK(said.problem
        == "port 8420 is the HTTP port of coordinator 'head' of cell "
           "'lab', not its discovery server");
  CHECK(said.hint == "use --join 10.0.0.1:11811");
}

TEST_CASE("a node that sees nobody is told which public domain it looks at") {
  CHECK_THAT(diagnose_solitude(99).problem, Contains("public domain 99"));
  CHECK_THAT(diagnose_solitude(99).hint, Contains("--peer"));
}
