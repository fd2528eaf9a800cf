#include "tools/roscell/daemon/node_address.hpp"
#include "tools/roscell/exit_code.hpp"

#include <catch2/catch.hpp>

#include <sstream>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::cli;
using namespace std::chrono_literals;

namespace {

using action = address_action;

interface_address on_eth0(const std::string& address, bool carrier = true) {
  return {"eth0", address, "0242ac110002", false, true, carrier};
}

const interface_address loopback{"lo", "127.0.0.1", "", true, false};

/// A node at 10.0.0.5 of eth0, and the interface as time goes on.
struct followed_interface {
  explicit followed_interface(bool fixed = false, bool carrier = true)
      : tracker{on_eth0("10.0.0.5", carrier), fixed} {}

  void has(std::vector<interface_address> all) {
    all.push_back(loopback);
    tracker.observe(all, now);
  }

  /// Time passes, and whoever waits for `due` looks. True if there is something
  /// to be done.
  action after(std::chrono::milliseconds span) {
    const auto end = now + span;
    if (const auto due = tracker.due(); due && *due <= end)
      if (const auto what = tracker.action(*due); what != action::stay) {
        now = *due;
        return what;
      }
    now = end;
    return tracker.action(now);
  }

  address_tracker::time_point now{};
  address_tracker tracker;
};

} // namespace

TEST_CASE("an address that another one replaces is left for that one",
          "[address]") {
  followed_interface x;
  x.has({on_eth0("10.0.0.5")});
  CHECK_FALSE(x.tracker.due());
  x.has({on_eth0("10.0.0.9")});
  CHECK(x.after(1400ms) == action::stay);
  CHECK(x.after(1s) == action::renew);
  CHECK(x.tracker.successor() == "10.0.0.9");
}

TEST_CASE("an address that was gone for less than a second changes nothing",
          "[address]") {
  followed_interface x;
  x.has({});
  CHECK(x.after(999ms) == action::stay);
  x.has({on_eth0("10.0.0.5")});
  CHECK_FALSE(x.tracker.due());
  CHECK(x.after(1h) == action::stay);
}

TEST_CASE("an address that was gone for longer is made anew once it is settled",
          "[address]") {
  followed_interface x;
  x.has({});
  CHECK(x.after(40s) == action::stay);
  x.has({on_eth0("10.0.0.5")});
  CHECK(x.after(1499ms) == action::stay);
  CHECK(x.after(1ms) == action::renew);
  CHECK(x.tracker.successor() == "10.0.0.5");
}

TEST_CASE("an interface that flaps each second is made anew once, at the end",
          "[address]") {
  followed_interface x;
  for (int i = 0; i < 30; ++i) {
    x.has({});
    REQUIRE(x.after(1s) == action::stay);
    x.has({on_eth0("10.0.0.5")});
    REQUIRE(x.after(1s) == action::stay);
  }
  CHECK(x.after(1s) == action::renew);
}

TEST_CASE("a named interface is waited for as long as it takes", "[address]") {
  followed_interface x;
  x.has({});
  CHECK_FALSE(x.tracker.due());
  CHECK(x.after(24h) == action::stay);
}

TEST_CASE("an address that was given as one is given up after ten seconds",
          "[address]") {
  followed_interface x{true};
  // Another one of the same interface does not do.
  x.has({on_eth0("10.0.0.9")});
  CHECK(x.after(9999ms) == action::stay);
  CHECK(x.after(1ms) == action::give_up);
}

TEST_CASE("an address that was given as one and comes back in time is kept",
          "[address]") {
  followed_interface x{true};
  x.has({});
  CHECK(x.after(9s) == action::stay);
  x.has({on_eth0("10.0.0.5")});
  CHECK(x.after(2s) == action::renew);
  CHECK(x.tracker.successor() == "10.0.0.5");
}

TEST_CASE("a further address of the interface changes nothing", "[address]") {
  followed_interface x;
  x.has({on_eth0("10.0.0.1"), on_eth0("10.0.0.5")});
  CHECK_FALSE(x.tracker.due());
  CHECK(x.after(1h) == action::stay);
  x.has({on_eth0("10.0.0.1")});
  CHECK(x.after(2s) == action::renew);
  CHECK(x.tracker.successor() == "10.0.0.1");
}

TEST_CASE("a carrier that goes and comes back changes nothing", "[address]") {
  followed_interface x;
  x.has({on_eth0("10.0.0.5", false)});
  CHECK(x.after(40s) == action::stay);
  x.has({on_eth0("10.0.0.5")});
  CHECK(x.after(40s) == action::stay);
}

TEST_CASE("a new address is taken once its interface has a carrier",
          "[address]") {
  followed_interface x;
  x.has({on_eth0("10.0.0.9", false)});
  CHECK(x.after(1h) == action::stay);
  x.has({on_eth0("10.0.0.9")});
  CHECK(x.after(2s) == action::renew);
}

TEST_CASE("a node that began without a carrier is made anew at once when that "
          "comes",
          "[address]") {
  followed_interface x{false, false};
  x.has({on_eth0("10.0.0.5", false)});
  CHECK(x.after(1h) == action::stay);
  x.has({on_eth0("10.0.0.5")});
  CHECK(x.after(2s) == action::renew);
  CHECK(x.tracker.successor() == "10.0.0.5");
}

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
