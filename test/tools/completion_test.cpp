#include "tools/roscell/commands/completion.hpp"

#include "tools/roscell/commands.hpp"

#include "test/words.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

std::string script(std::string (*completion)(const CLI::App&)) {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  return completion(app);
}

fs::path scratch_file() {
  return fs::temp_directory_path()
         / ("roscell-completion-" + std::to_string(getpid()));
}

/// What a shell prints that runs this text, without an error.
std::string run_by(const std::string& shell, const std::string& text) {
  const auto file = scratch_file();
  std::ofstream{file} << text;
  const auto command = shell + " " + file.string() + " 2>&1";
  auto* out = popen(command.c_str(), "r");
  REQUIRE(out != nullptr);
  std::string printed;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), out) != nullptr)
    printed += buffer.data();
  INFO(printed);
  CHECK(pclose(out) == 0);
  fs::remove(file);
  return printed;
}

/// Whether this machine has the shell; says so if not.
bool has_shell(const std::string& name) {
  if (std::system(("command -v " + name + " > /dev/null").c_str()) == 0)
    return true;
  WARN("skipped: " << name << " is not installed");
  return false;
}

using roscell::test::has;

/// What a shell with the script offers after `words`; `roscell` itself is
/// replaced by a function that prints `table`.
std::string offered(const std::string& words, const std::string& table = "") {
  return run_by("bash -u", script(bash_completion) + "roscell() { printf '%s' '"
                               + table + "'; }\ncompopt() { :; }\nCOMP_WORDS=("
                               + words
                               + ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                                 "COMP_LINE=\"${COMP_WORDS[*]}\"\n_roscell\n"
                                 "echo \"${COMPREPLY[*]}\"\n");
}

/// What fish offers at the end of `line`, a word in each line; `roscell` prints
/// `table`.
std::string offered_by_fish(const std::string& line,
                            const std::string& table = "") {
  return run_by("fish --no-config",
                script(fish_completion) + "function roscell\n  printf '%s' '"
                    + table + "'\nend\ncomplete -C '" + line
                    + "' | string replace -r '\\t.*' ''\ntrue\n");
}

} // namespace

TEST_CASE("completion offers every command", "[tools]") {
  CHECK(
      offered("roscell ''")
      == "node run stop restart check new request plan form transfer release "
         "drain undrain rebalance "
         "status cells nodes tasks instances topics skills transfers describe "
         "graph why trace inspect top doctor dashboard env echo hz bw events "
         "logs "
         "shell completion help "
         "version "
         "--version "
         "--help\n");
  CHECK(offered("roscell no") == "node nodes\n");
  CHECK(offered("roscell new ''") == "task config\n");
  CHECK(offered("roscell skills ''") == "show new check\n");
  CHECK(offered("roscell skill n") == "new\n");
}

TEST_CASE("completion offers a command's options", "[tools]") {
  CHECK(offered("roscell status --a") == "--actors\n");
  CHECK(offered("roscell status --c") == "--cost\n");
  CHECK(offered("roscell node --da") == "--data-dir\n");
  CHECK(offered("roscell node --conf") == "--config\n");
}

TEST_CASE("completion offers the values of an option", "[tools]") {
  CHECK(offered("roscell status -o ''") == "table json\n");
  CHECK(offered("roscell graph -o ''") == "text wide dot mermaid json\n");
  CHECK(offered("roscell node --runtime po") == "podman\n");
  CHECK(offered("roscell node --interface l") == "lo\n");
  CHECK(offered("roscell completion ''") == "bash zsh fish\n");
  CHECK(offered("roscell help rel") == "release\n");
  CHECK(offered("roscell help --man-pages /us") == "/usr\n");
  CHECK(offered("roscell form --instances t") == "terminate\n");
}

TEST_CASE("completion offers files", "[tools]") {
  CHECK(offered("roscell request /etc/host").find("/etc/hosts")
        != std::string::npos);
}

TEST_CASE("completion asks the node for ids", "[tools]") {
  CHECK(offered("roscell logs ''", "INSTANCE  TASK\nt-a-1  t\nt-b-2  t\n")
        == "t-a-1 t-b-2\n");
  CHECK(offered("roscell logs ''", "no instances\n") == "\n");
}

TEST_CASE("completion waits no longer for a node than a person does",
          "[tools]") {
  const auto* patience = "HEAD\n'\"$ROSCELL_TIMEOUT\"'\n";
  CHECK(offered("roscell logs ''", patience) == "600ms\n");
  CHECK(has(script(zsh_completion), "ROSCELL_TIMEOUT=600ms roscell $kind"));
  CHECK(has(script(fish_completion), "ROSCELL_TIMEOUT=600ms roscell $argv"));
}

TEST_CASE("completion offers nodes, then cells to move them to", "[tools]") {
  const std::string table = "NAME  X\none  a\ntwo  b\n";
  // The table is what any question is answered with; its kind is the echo.
  const auto asked = [](const std::string& words) {
    return offered(words, "HEAD\n'\"$1\"'\n");
  };
  CHECK(asked("roscell transfer ''") == "nodes\n");
  CHECK(asked("roscell transfer arm-1 ''") == "cells\n");
  CHECK(asked("roscell transfer --instances terminate ''") == "nodes\n");
  CHECK(asked("roscell transfer -o json arm-1 ''") == "cells\n");
  CHECK(asked("roscell form arm-1 arm-2 ''") == "nodes\n");
  CHECK(asked("roscell release ''") == "nodes\n");
  CHECK(asked("roscell transfers ''") == "transfers\n");
  CHECK(offered("roscell form ''", table) == "one two\n");
}

TEST_CASE("completion never lets the shell expand what a node says",
          "[tools]") {
  CHECK(offered("roscell logs ''", "INSTANCE\n$(echo bad)\n`date`\nt-a-1\n")
        == "t-a-1\n");
}

TEST_CASE("each shell is told of every command, option and argument",
          "[tools]") {
  const auto zsh = script(zsh_completion);
  CHECK(zsh.rfind("#compdef roscell\n", 0) == 0);
  CHECK(has(zsh, "\n    release)\n"));
  CHECK(has(zsh, "'*--output[Form of what is printed]:--output: "
                 "_roscell_words table json'"));
  CHECK(has(zsh, "'1:NODE: _roscell_ids nodes'"));
  CHECK(has(zsh, "'*:CELL: _roscell_ids cells'"));
  const auto fish = script(fish_completion);
  CHECK(has(fish, "-n __roscell_first -a release -d "));
  CHECK(has(fish, "'__roscell_in tasks' -s o -l output"));
  CHECK(has(fish, "'__roscell_at transfer 1 one "));
  CHECK(has(fish, "-a '(__roscell_ids cells)'"));
}

TEST_CASE("zsh takes its completion script", "[tools]") {
  if (!has_shell("zsh"))
    return;
  CHECK(run_by("zsh -n", script(zsh_completion)).empty());
  // Without its editor zsh completes nothing; what is called is printed.
  CHECK(run_by("zsh -f",
               "compdef() { print defined }\n" + script(zsh_completion)
                   + "compadd() { print -r -- \"$@\" }\n"
                     "roscell() { print -l HEAD t-a-1 '$(bad)' t-b-2 }\n"
                     "words=(logs ''); CURRENT=2\n_roscell_ids instances\n"
                     "_roscell_words table json\n")
        == "defined\n-- t-a-1 t-b-2\n-- table json\n");
}

TEST_CASE("zsh loads its completion script as a function, too", "[tools]") {
  if (!has_shell("zsh"))
    return;
  const auto folder = scratch_file().string() + ".d";
  fs::create_directory(folder);
  std::ofstream{folder + "/_roscell"} << script(zsh_completion);
  CHECK(run_by("zsh -f", "fpath=(" + folder
                             + ")\nautoload -Uz _roscell\n"
                               "_describe() { print -r -- $#_roscell_all }\n"
                               "words=(roscell ''); CURRENT=2\n_roscell\n")
        == "18\n");
  fs::remove_all(folder);
}

TEST_CASE("fish completes commands, options, values and ids", "[tools]") {
  if (!has_shell("fish"))
    return;
  CHECK(run_by("fish -n", script(fish_completion)).empty());
  CHECK(offered_by_fish("roscell rel") == "release\n");
  CHECK(offered_by_fish("roscell status --a") == "--actors\n");
  CHECK(offered_by_fish("roscell status -o ") == "json\ntable\n");
  const std::string table = "NAME\none\n$(bad)\ntwo\n";
  CHECK(offered_by_fish("roscell transfer ", table) == "one\ntwo\n");
  CHECK(offered_by_fish("roscell transfer -o json arm-1 ", table)
        == "one\ntwo\n");
  CHECK(offered_by_fish("roscell release arm-1 --instances t")
        == "terminate\n");
}
