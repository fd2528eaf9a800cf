#include "tools/roscell/commands/help.hpp"

#include "tools/roscell/commands.hpp"

#include "test/words.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

/// What groff shows of a page, with its warnings; blanks count as one.
std::string shown(const std::string& page) {
  const auto file = fs::temp_directory_path()
                    / ("roscell-manual-" + std::to_string(getpid()));
  std::ofstream{file} << page;
  const auto command =
      "groff -man -Tascii -P-c -rLL=200n -rHY=0 -ww " + file.string() + " 2>&1";
  auto* out = popen(command.c_str(), "r");
  REQUIRE(out != nullptr);
  std::string text;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), out) != nullptr)
    for (const char* x = buffer.data(); *x != '\0'; ++x) {
      // A letter over itself is bold.
      if (*x == '\b' && !text.empty())
        text.pop_back();
      else if ((*x != ' ' && *x != '\n') || text.empty() || text.back() != ' ')
        text += *x == '\n' ? ' ' : *x;
    }
  CHECK(pclose(out) == 0);
  fs::remove(file);
  return text;
}

using roscell::test::has;

bool has_groff() {
  if (std::system("groff --version > /dev/null 2>&1") == 0)
    return true;
  WARN("skipped: groff is not installed");
  return false;
}

} // namespace

TEST_CASE("no text of a manual page is a request of troff", "[tools]") {
  CHECK(roff(".sp \\n(.x") == "\\&.sp \\en(.x");
  CHECK(roff("'br") == "\\(aqbr");
  CHECK(roff("--to \"x\"") == "\\-\\-to \\(dqx\\(dq");
  CHECK(roff("`~^`") == "\\(ga\\(ti\\(ha\\(ga");
  CHECK(roff("").empty());
}

TEST_CASE("a manual page shows what the help says", "[tools]") {
  if (!has_groff())
    return;
  CLI::App app{"Cells."};
  app.name("roscell");
  auto& command = *app.add_subcommand("odd", ".Odd 'things' \\are\ndone.");
  std::string value;
  command.add_option("-f,--form", value, "A `form` -- or \"none\"")
      ->option_text("A|B [A]");
  command.add_option("THING", value, "What is done")->option_text(" ");
  auto& below = *command.add_subcommand("part", "Do a part.");
  below.add_option("--size", value, "How much")->option_text("N");
  below.footer("Examples:\n  roscell odd part");
  command.footer("It ends.\n\nExamples:\n  roscell odd \\\n      .x 'y'");
  const auto text = shown(command_page(app, command));
  CHECK(has(text, "NAME roscell-odd - .Odd 'things' \\are done SYNOPSIS"));
  CHECK(has(text, "SYNOPSIS roscell odd [OPTIONS] [THING] "));
  CHECK(has(text, "-f, --form A|B [A] A `form` -- or \"none\""));
  CHECK(has(text, "THING What is done"));
  CHECK(has(text, "roscell odd part [OPTIONS] Do a part."));
  CHECK(has(text, "--size N How much Examples: roscell odd part"));
  CHECK(has(text, "NOTES It ends."));
  CHECK(has(text, "EXAMPLES roscell odd \\ .x 'y'"));
}

TEST_CASE("groff has nothing to warn of in any manual page", "[tools]") {
  if (!has_groff())
    return;
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  const auto program = shown(program_page(app));
  CHECK_FALSE(has(program, "warning"));
  CHECK(has(program, "EXIT CODES 0 done"));
  for (const auto* command : app.get_subcommands({})) {
    const auto name = command->get_name();
    CAPTURE(name);
    CHECK(has(program, "roscell-" + name + "(1)"));
    const auto text = shown(command_page(app, *command));
    CHECK_FALSE(has(text, "warning:"));
    CHECK(has(text, "SYNOPSIS roscell " + name));
  }
}

TEST_CASE("a page repeats nothing of the program's own", "[tools]") {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  CHECK(has(program_page(app), "NO_COLOR"));
  CHECK_FALSE(has(command_page(app, *app.get_subcommand("new")), "NO_COLOR"));
}
