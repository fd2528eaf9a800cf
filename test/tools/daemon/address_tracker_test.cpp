#include "tools/roscell/daemon/address/address_tracker.hpp"

#include <catch2/catch.hpp>

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
