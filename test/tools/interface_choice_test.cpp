#include "tools/roscell/daemon/interface_choice.hpp"

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
