#include "tools/roscell/commands/help.hpp"

#include "tools/roscell/commands.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <string>
#include <vector>

using namespace roscell::cli;

namespace {

/// What is said of a command line that cannot be parsed, and its hint.
std::string reported(std::vector<std::string> words) {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  try {
    // CLI11 takes the words last first.
    app.parse(std::vector<std::string>{words.rbegin(), words.rend()});
  } catch (const CLI::ParseError& e) {
    const auto why = usage_error(app, e);
    CHECK(why.code == exit_usage);
    return std::string{why.what()} + "; " + why.hint;
  }
  return "it is parsed";
}

} // namespace

TEST_CASE("a misspelt command is told with the one that was meant", "[tools]") {
  CHECK(reported({"nodess"})
        == "there is no command 'nodess'; did you mean `roscell nodes`?");
  CHECK(reported({"coffee"})
        == "there is no command 'coffee'; `roscell --help` lists the commands");
  CHECK(reported({})
        == "a command is missing; `roscell --help` lists the commands");
}

TEST_CASE("a misspelt option is told with the one that was meant", "[tools]") {
  CHECK(reported({"node", "--jion", "10.0.0.1"})
        == "`roscell node` has no option --jion; did you mean --join?");
  CHECK(reported({"transfer", "--cel=line", "arm-1"})
        == "`roscell transfer` has no option --cel; did you mean --cell?");
  CHECK(reported({"nodes", "--colour"})
        == "`roscell nodes` has no option --colour; `roscell nodes --help` "
           "shows how it is used");
  CHECK(reported({"--versoin"})
        == "there is no option --versoin; did you mean --version?");
}

TEST_CASE("an argument too many or too few is told with the help to read",
          "[tools]") {
  CHECK(reported({"tasks", "a", "b"})
        == "'b' is one argument too many for `roscell tasks`; `roscell tasks "
           "--help` shows how it is used");
  CHECK(reported({"plan"})
        == "FILE is required; `roscell plan --help` shows how it is used");
  CHECK(reported({"tasks", "-o", "xml"}).find("roscell tasks --help")
        != std::string::npos);
}

TEST_CASE("help and version are commands, too", "[tools]") {
  CHECK(reported({"help"}) == "it is parsed");
  CHECK(reported({"help", "node"}) == "it is parsed");
  CHECK(reported({"version"}) == "it is parsed");
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  app.parse(std::vector<std::string>{"nod", "help"});
  REQUIRE(chosen);
  try {
    chosen();
    FAIL("there is no such command");
  } catch (const command_error& e) {
    CHECK(e.hint == "did you mean `roscell node`?");
  }
}
