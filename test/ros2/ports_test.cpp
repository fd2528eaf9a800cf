#include "cell_fixture.hpp"

#include "dds/server_addresses.hpp"
#include "roscell/ros2.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/engine/life/unique_fd.hpp"
#include "skills/engine/primitive_base_engine.hpp"
#include "skills/ros2/participant.hpp"

#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

using namespace roscell;
using namespace roscell::test;

namespace {

using taken_ports = std::vector<engine::unique_fd>;

/// Takes `count` ports from `first` on, those that are free, `step` apart.
taken_ports take(const char* address, std::uint16_t first, unsigned count,
                 unsigned step = 2) {
  taken_ports result;
  for (unsigned i = 0; i < count; ++i) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(first + i * step));
    inet_pton(AF_INET, address, &at.sin_addr);
    engine::unique_fd taken{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    if (bind(taken.get(), reinterpret_cast<sockaddr*>(&at), sizeof(at)) == 0)
      result.push_back(std::move(taken));
  }
  return result;
}

/// RTPS 2.3, 9.6.1.1: where the unicast ports of a domain begin.
constexpr std::uint16_t ports_of(std::uint32_t domain) {
  return static_cast<std::uint16_t>(7400 + 250 * domain + 10);
}

std::uint16_t must_find(const std::vector<std::string>& addresses,
                        std::uint16_t first, unsigned places) {
  const auto found = free_port(addresses, first, places);
  REQUIRE(std::holds_alternative<std::uint16_t>(found));
  return std::get<std::uint16_t>(found);
}

class idle : public engine::executor {
public:
  void process(const engine::frame&, engine::emitter&) override {
    // It never comes to that.
  }

  void release() override {
    // Nothing is held.
  }
};

} // namespace

TEST_CASE("a port is free only where it is so on every address") {
  constexpr auto first = ports_of(110);
  const auto elsewhere = take("127.0.0.1", first, 3);
  CHECK(must_find({"127.0.0.2"}, first, 10) == first);
  CHECK(must_find({"127.0.0.2", "127.0.0.1"}, first, 10) == first + 6);
}

TEST_CASE("where all the places are taken any other port is given") {
  constexpr auto first = ports_of(111);
  const auto crowd = take("127.0.0.1", first, 20);
  const auto port = must_find({"127.0.0.2", "127.0.0.1"}, first, 20);
  CHECK(port != 0);
  CHECK((port < first || port >= first + 40));
}

TEST_CASE("the places of the highest domain end with the ports") {
  constexpr auto first = ports_of(232);
  const auto crowd = take("127.0.0.1", first, 70);
  CHECK(must_find({"127.0.0.1"}, first, 100) > 1023);
}

TEST_CASE("an address that this host does not have has no free port") {
  const auto found = free_port({"192.0.2.1"}, 7410, 3);
  REQUIRE(std::holds_alternative<std::error_code>(found));
  CHECK(std::get<std::error_code>(found) == std::errc::address_not_available);
}

TEST_CASE("skills hear each other beside more programs than a domain has ports "
          "for") {
  constexpr std::uint32_t domain = 112;
  const auto crowd = take("127.0.0.1", ports_of(domain), 400, 1);
  check_message(cell{0, domain});
}

TEST_CASE("a participant that no port is left for is refused, not deaf") {
  ros2::participant_config config;
  config.domain_id = 113;
  config.node_name = "late";
  const auto crowd = take("0.0.0.0", ports_of(config.domain_id), 350, 1);
  CHECK_THROWS_WITH(ros2::participant{config},
                    Catch::Contains("UDP ports that DDS tries"));
}

TEST_CASE("a skill whose participant cannot be made ends, saying why, and is "
          "never ready") {
  temp_folder folder;
  notify_receiver node{folder / "notify"};
  variables said{{"ROS_DOMAIN_ID", "114"}};
  taken_ports crowd;
  std::string reason;
  SECTION("for want of a port") {
    crowd = take("0.0.0.0", ports_of(114), 350, 1);
    reason = "cannot start: all UDP ports that DDS tries in ROS domain 114";
  }
  SECTION("for want of a way to its node's server") {
    // Nobody may send there without asking for it.
    said["ROS_DISCOVERY_SERVER"] = "255.255.255.255:11811";
    reason = "cannot start: there is no route to the discovery server";
  }
  engine::registry parts;
  ros2::add_ros2_protocol(parts, lookup_in(said));
  parts.add_executor<idle>("idle");
  engine::environment env;
  env.model = "idle";
  env.notify_socket = folder / "notify";
  env.inputs = {{"ros2", "/image", "sensor_msgs/msg/Image"}};
  logbook log;
  engine::primitive_base_engine program{parts, env, log.say()};
  CHECK(program.run() == engine::exit_code::cannot_start);
  CHECK_FALSE(node.receive_now());
  REQUIRE(log.lines().size() == 1);
  CHECK_THAT(log.lines().front(), Catch::StartsWith(reason));
}
