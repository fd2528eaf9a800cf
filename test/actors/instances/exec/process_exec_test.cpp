#include "actors/instances/exec/process_exec.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("a command has what its instance has, but for its records") {
  exec_order order;
  order.command = {"ls", "-l"};
  const std::vector<std::string> shim{
      "/lib/shim", "--capabilities", "0",       "--dir",   "/data/i",
      "--cwd",     "/skill",         "--fence", "/data/f", "--cgroup",
      "/cg/i",     "--user",         "7:7",     "--",      "/skill/bin/run",
      "--cwd",     "/trap"};
  CHECK(beside(shim, order)
        == std::vector<std::string>{"--attached", "pipes", "--capabilities",
                                    "0", "--cwd", "/skill", "--cgroup", "/cg/i",
                                    "--user", "7:7", "--", "ls", "-l"});
  order.terminal = true;
  CHECK(
      beside({"/lib/shim"}, order)
      == std::vector<std::string>{"--attached", "terminal", "--", "ls", "-l"});
}

TEST_CASE("no command begins beside a process that is gone") {
  exec_order order;
  order.instance = "i";
  order.container = "1:1";
  order.command = {"ls"};
  const auto answer = process_opener(nullptr, "/lib/shim")(order, {});
  const auto* why = std::get_if<edge_error>(&answer);
  REQUIRE(why);
  CHECK(why->code == error_code::conflict);
}
