#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/environment.hpp"

#include <catch2/catch.hpp>

using namespace roscell::cli;
using Catch::Matchers::Contains;

namespace {

const variables hall{{"ROS_DISCOVERY_SERVER", ";;;10.0.0.7:11811"},
                     {"ROS_DOMAIN_ID", "7"}};

} // namespace

TEST_CASE("a shell gets the cell's variables, quoted, and nothing that "
          "misleads",
          "[tools]") {
  const auto text = shell_lines("hall", hall);
  CHECK_THAT(text,
             Contains("export ROS_DISCOVERY_SERVER=';;;10.0.0.7:11811'\n"));
  CHECK_THAT(text, Contains("export ROS_DOMAIN_ID='7'\n"));
  CHECK_THAT(text, Contains("export RMW_IMPLEMENTATION='rmw_fastrtps_cpp'\n"));
  CHECK_THAT(text, Contains("unset ROS_LOCALHOST_ONLY"));
  CHECK_THAT(text, Contains("FASTRTPS_DEFAULT_PROFILES_FILE"));
}

TEST_CASE("what a node says cannot break out of its quotes or its comment",
          "[tools]") {
  const auto text =
      shell_lines("c\nrm -rf /", {{"ROS_DOMAIN_ID", "a'; rm -rf /; '"},
                                  {"X;rm -rf /;Y", "1"}});
  CHECK_THAT(text, Contains("export ROS_DOMAIN_ID='a'\\''; rm -rf /; '\\'"));
  CHECK_THAT(text, !Contains("\nrm") && !Contains("X;"));
  CHECK_THAT(super_client_lines("c\nrm -rf /", hall, "/p"), !Contains("\nrm"));
}

TEST_CASE("who shall see all of a cell gets a profile in place of the "
          "server's address",
          "[tools]") {
  const auto text = super_client_lines("hall", hall, "/run/p.xml");
  CHECK_THAT(text, Contains("unset ROS_DISCOVERY_SERVER\n"));
  CHECK_THAT(text,
             Contains("export FASTRTPS_DEFAULT_PROFILES_FILE='/run/p.xml'\n"));
  CHECK_THAT(text, Contains("export ROS_DOMAIN_ID='7'\n"));
  const auto profile = super_client_profile(hall);
  CHECK_THAT(profile, Contains("44.53.03.5f.45.50.52.4f.53.49.4d.41"));
  CHECK_THAT(profile, Contains("<address>10.0.0.7</address>"));
  CHECK_THAT(profile, Contains("<port>11811</port>"));
}

TEST_CASE("a profile is refused where no server is known", "[tools]") {
  CHECK_THROWS_AS(super_client_profile({}), command_error);
  CHECK_THROWS_AS(super_client_profile({{"ROS_DISCOVERY_SERVER", ";;"}}),
                  command_error);
}
