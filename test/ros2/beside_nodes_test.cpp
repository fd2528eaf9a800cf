#include "cell_fixture.hpp"

#include "actors/edge/dds/server_inquiry.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

/// A node that looks for the coordinator behind the discovery server.
class member {
public:
  member(const cell& home, logbook& log) {
    server_inquiry_options options;
    options.server_address = "127.0.0.1";
    options.server_port = home.port();
    auto opened = server_inquiry::open(
        options, [say = log.say()](const server_sighting& seen) {
          say("server says " + seen.announcement);
        });
    if (auto* error = std::get_if<edge_error>(&opened))
      FAIL(error->message);
    inquiry_ = std::get<0>(std::move(opened));
  }

private:
  std::unique_ptr<server_inquiry> inquiry_;
};

} // namespace

TEST_CASE("skills find each other beside nodes that look for their cell") {
  cell home{0};
  logbook before;
  logbook after;
  member first{home, before};
  REQUIRE(before.wait_for("server says test"));
  check_message(home);
  member second{home, after};
  CHECK(after.wait_for("server says test"));
  check_message(home);
  CHECK(before.lines() == std::vector<std::string>{"server says test"});
}
