#include "actors/edge/host/interfaces.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

const std::vector<interface_address> robot{
    {"eth0", "10.0.0.5", "0242ac110002", false, true},
    {"docker0", "172.17.0.1", "0242aaaaaaaa", false, false},
    {"tun0", "10.8.0.2", "", false, false},
    {"lo", "127.0.0.1", "", true, false},
};

} // namespace

TEST_CASE("an interface is found by its name or its address", "[interfaces]") {
  for (const char* text : {"tun0", "10.8.0.2"}) {
    auto found = resolve_interface(text, robot);
    REQUIRE(std::holds_alternative<interface_address>(found));
    CHECK(std::get<interface_address>(found).address == "10.8.0.2");
  }
}

TEST_CASE("an interface means its primary address, not its smallest",
          "[interfaces]") {
  std::vector<interface_address> all{
      {"lo", "127.0.0.1", "", true, false},
      {"eth1", "10.0.0.50", "0242ac110003", false, true},
      {"eth1", "10.0.0.100", "0242ac110003", false, true},
      {"eth1", "10.0.0.2", "0242ac110003", false, true},
      {"eth0", "192.168.1.7", "0242ac110002", false, true},
  };
  order_interfaces(all);
  CHECK(describe_interfaces(all)
        == "eth0 192.168.1.7, eth1 10.0.0.50, eth1 10.0.0.100, "
           "eth1 10.0.0.2, lo 127.0.0.1");
  const auto found = resolve_interface("eth1", all);
  REQUIRE(std::holds_alternative<interface_address>(found));
  CHECK(std::get<interface_address>(found).address == "10.0.0.50");
}

TEST_CASE("an unknown interface is refused with a list of what there is",
          "[interfaces]") {
  for (const char* text : {"eth1", "10.0.0.6", "", "10.0.0.5 "}) {
    auto found = resolve_interface(text, robot);
    REQUIRE(std::holds_alternative<edge_error>(found));
    auto& error = std::get<edge_error>(found);
    CHECK(error.message.find(text) != std::string::npos);
    CHECK(error.hint
          == "this host has: eth0 10.0.0.5, docker0 172.17.0.1, "
             "tun0 10.8.0.2, lo 127.0.0.1");
  }
}

TEST_CASE("a host without interfaces says so", "[interfaces]") {
  CHECK(describe_interfaces({}) == "none");
}

TEST_CASE("a nameless node is named after the chosen interface's MAC",
          "[interfaces]") {
  CHECK(mac_node_name("docker0", robot, "pi") == "node-0242aaaaaaaa");
  CHECK(mac_node_name("10.0.0.5", robot, "pi") == "node-0242ac110002");
}

TEST_CASE("without a MAC of its own the first interface's counts",
          "[interfaces]") {
  for (const char* chosen : {"", "lo", "tun0", "gone"})
    CHECK(mac_node_name(chosen, robot, "pi") == "node-0242ac110002");
}

TEST_CASE("without any MAC the host's name is made fit", "[interfaces]") {
  const std::vector<interface_address> bare{robot.back()};
  CHECK(mac_node_name("lo", bare, "My_Pi.local") == "node-my-pi-local");
  CHECK(mac_node_name("lo", {}, "") == "node-unnamed");
}

TEST_CASE("this host lists loopback last and names itself the same way twice",
          "[interfaces]") {
  auto all = list_interfaces();
  REQUIRE_FALSE(all.empty());
  CHECK(all.back().address == "127.0.0.1");
  CHECK(all.back().loopback);
  CHECK(mac_node_name() == mac_node_name());
  CHECK(mac_node_name("lo").rfind("node-", 0) == 0);
  CHECK(std::holds_alternative<interface_address>(resolve_interface("lo")));
}
