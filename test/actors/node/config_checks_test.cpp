#include "actors/edge/process/privileges.hpp"
#include "actors/node/config_checks.hpp"
#include "messages/failure.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

using namespace roscell;

namespace {

chosen_runtime processes() {
  chosen_runtime result;
  result.name = "process";
  return result;
}

chosen_runtime docker() {
  chosen_runtime result;
  result.name = "docker";
  result.socket = "/var/run/docker.sock";
  return result;
}

std::string problem_with(const std::string& line,
                         const chosen_runtime& runtime) {
  node_config config;
  config.grants = {line};
  const auto why = check_grants(config, runtime);
  return why ? to_failure(why).message : std::string{"none"};
}

} // namespace

TEST_CASE("A node grants what it may do itself", "[grants]") {
  const bool is_root = ::geteuid() == 0;
  CHECK((problem_with("x=capability:SYS_NICE", processes()) == "none")
        == has_capability(own_capabilities(), "SYS_NICE"));
  CHECK((problem_with("x=user:nobody", processes()) == "none") == is_root);
  CHECK((problem_with("x=scheduling:nice:-20", processes()) == "none")
        == is_root);
  // An engine has the powers that it gives.
  CHECK(problem_with("x=capability:NET_ADMIN", docker()) == "none");
  CHECK(problem_with("x=scheduling:rr:9", docker()) == "none");
}

TEST_CASE("A node refuses to start with a grant that cannot be meant",
          "[grants]") {
  CHECK(problem_with("x=user:nobody-of-that-name", processes())
        == "--grant: there is no user 'nobody-of-that-name' on this host");
  CHECK(problem_with("x=user:nobody", docker()).find("run as the node's user")
        != std::string::npos);
  CHECK(problem_with("x=capability:ALL", docker()).find("no capability 'ALL'")
        != std::string::npos);
}

TEST_CASE("Capabilities have the kernel's numbers", "[grants]") {
  CHECK(capability_number("CHOWN") == 0);
  CHECK(capability_number("NET_RAW") == 13);
  CHECK(capability_number("SYS_NICE") == 23);
  CHECK(capability_number("CHECKPOINT_RESTORE") == 40);
  CHECK_FALSE(capability_number("net_raw"));
  CHECK(to_capabilities({"CHOWN", "NET_RAW", "NONE"}) == 0x2001);
}
