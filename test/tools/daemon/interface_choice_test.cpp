#include "tools/roscell/daemon/address/interface_choice.hpp"

#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace roscell;
using namespace roscell::cli;

namespace {

const std::vector<interface_address> two{
    {"eth0", "10.0.0.5", "0242ac110002", false, true},
    {"lo", "127.0.0.1", "", true, false}};

} // namespace

TEST_CASE("a person picks an interface by its number", "[tools]") {
  std::istringstream answers{"2\n"};
  std::ostringstream out;
  CHECK(ask_for_interface(two, answers, out).name == "lo");
  CHECK(out.str().find("  1  eth0  10.0.0.5\n") != std::string::npos);
  CHECK(out.str().find("  2  lo  127.0.0.1  (this machine only)\n")
        != std::string::npos);
}

TEST_CASE("an answer that is no number of the list is asked for again",
          "[tools]") {
  std::istringstream answers{"\n0\n3\neth0\n99999999999999999999\n1x\n1\n"};
  std::ostringstream out;
  CHECK(ask_for_interface(two, answers, out).name == "eth0");
}

TEST_CASE("the end of the answers is a wrong usage", "[tools]") {
  std::istringstream answers{"7\n"};
  std::ostringstream out;
  CHECK_THROWS_AS(ask_for_interface(two, answers, out), command_error);
}

TEST_CASE("an interface that is named may come later, an address may not",
          "[tools]") {
  CHECK(choose_interface("no-such-iface0") == "no-such-iface0");
  CHECK(choose_interface("127.0.0.1") == "127.0.0.1");
  for (const char* wanted : {"10.231.99.1", "10.0.0.300", "fe80::1", "a/b",
                             "eth0 ", "no-such-interface"})
    CHECK_THROWS_AS(choose_interface(wanted), command_error);
}

TEST_CASE("what is waited for is named, and what there is instead", "[tools]") {
  const std::vector<interface_address> all{
      {"eth0", "10.0.0.5", "0242ac110002", false, true, false},
      {"lo", "127.0.0.1", "", true, false}};
  const std::vector<host_link> links{
      {"eth0", true}, {"eth1", true}, {"lo", true}, {"wlan0", false}};
  const auto lacks = [&](const std::string& wanted, bool with_carrier) {
    const auto found = find_interface(wanted, with_carrier, all, links);
    const auto* text = std::get_if<std::string>(&found);
    return text ? *text : "";
  };
  CHECK(lacks("eht0", false) == "'eht0' is not there");
  CHECK(describe_links(all, links)
        == "eth0 10.0.0.5, lo 127.0.0.1, eth1 (no IPv4 address), wlan0 (down)");
  CHECK(lacks("eth1", false)
        == "interface 'eth1' has no IPv4 address, and IPv6 is not used");
  CHECK(lacks("wlan0", false) == "interface 'wlan0' is down");
  for (const char* wanted : {"eth0", "10.0.0.5"})
    CHECK(lacks(wanted, true)
          == "interface 'eth0' (10.0.0.5) has no carrier: no cable is in, or "
             "no network is in reach");
  CHECK(lacks("eth0", false).empty());
  CHECK(lacks("lo", true).empty());
}
