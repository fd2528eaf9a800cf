#include "tools/roscell/shell/vocabulary.hpp"

#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

using namespace roscell::cli;

namespace {

int exit_code_of(const std::string& line) {
  return run_line(line, {}, nullptr);
}

} // namespace

TEST_CASE("help lists the shell's own words first", "[shell]") {
  CLI::App app;
  action chosen;
  set_up_vocabulary(app, chosen, nullptr);
  const auto help = app.help();
  CHECK(help.find("tree") < help.find("\n  node "));
  CHECK(help.find("follow") < help.find("\n  node "));
  CHECK(help.find("exit, quit") < help.find("\n  node "));
}

TEST_CASE("a line is parsed as the program's command line", "[shell]") {
  CHECK(exit_code_of("version") == exit_done);
  CHECK(exit_code_of("roscell version") == exit_done);
  CHECK(exit_code_of("") == exit_done);
  CHECK(exit_code_of("exit") == exit_done);
  CHECK(exit_code_of("taks") == exit_usage);
  CHECK(exit_code_of("version --nope") == exit_usage);
  CHECK(exit_code_of("check '/there is no such file'") == exit_usage);
}

TEST_CASE("what makes no sense in a shell is refused", "[shell]") {
  CHECK(exit_code_of("node") == exit_usage);
  CHECK(exit_code_of("shell") == exit_usage);
  CHECK(exit_code_of("follow") == exit_usage);
  CHECK(exit_code_of("tasks 'x") == exit_usage);
  CHECK(exit_code_of("tasks x\\") == exit_usage);
}

TEST_CASE("few words change the shell itself", "[shell]") {
  CHECK(changes_shell({"follow", "--off"}));
  CHECK(changes_shell({"quit"}));
  CHECK_FALSE(changes_shell({"tree"}));
  CHECK_FALSE(changes_shell({}));
}
