#include "tools/roscell/completion/completion.hpp"

#include "tools/roscell/commands.hpp"

#include "test/words.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

/// What a script is told of a line, without what the words mean.
std::string words_for(const std::string& line) {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  std::istringstream lines{
      completion_lines(app, line, [](const std::string& kind) {
        return std::vector<std::string>{kind + "-1", "$(bad)"};
      })};
  std::string result;
  for (std::string x; std::getline(lines, x);)
    result += (result.empty() ? "" : " ") + x.substr(0, x.find('\t'));
  return result;
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

/// A script of a shell, in whose place of `roscell` a function tells what is
/// asked of it, and these lines.
std::string with_script(const std::string& shell, const std::string& lines) {
  const auto body =
      shell == "fish"
          ? "function roscell\n  echo $argv >&2\n  printf '" + lines
                + "'\nend\n"
          : "roscell() { echo \"$*\" >&2; printf '" + lines + "'; }\n";
  return completion_script(shell) + body;
}

/// What bash offers behind these words.
std::string offered_by_bash(const std::string& words,
                            const std::string& lines) {
  return run_by("bash -u", "compopt() { echo \"compopt $*\"; }\n"
                               + with_script("bash", lines) + "COMP_WORDS=("
                               + words
                               + ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                                 "COMP_LINE=\"${COMP_WORDS[*]}\"\n"
                                 "COMP_POINT=${#COMP_LINE}\n"
                                 "_roscell 2>/dev/null\n"
                                 "echo \"${COMPREPLY[*]}\"\n");
}

} // namespace

TEST_CASE("completion offers every command, and says what it does", "[tools]") {
  CHECK(words_for("roscell ").find("apply audit bw cell cells check") == 0);
  CHECK(words_for("roscell no") == "node nodes");
  CHECK(words_for("roscell new ") == "config task");
  CHECK(words_for("roscell skill n") == "new");
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  CHECK(completion_lines(app, "roscell rel", {}).rfind("release\t", 0) == 0);
  CHECK(has(completion_lines(app, "roscell status --a", {}),
            "--actors\tAlso list"));
}

TEST_CASE("completion offers options and their values", "[tools]") {
  CHECK(words_for("roscell status --c") == "--cost");
  CHECK(words_for("roscell status -o ") == "json table");
  CHECK(words_for("roscell status --output=j") == "--output=json");
  CHECK(words_for("roscell node --runtime po") == "podman");
  CHECK(words_for("roscell node --interface l") == "lo");
  CHECK(words_for("roscell node --capacity m") == ":more memory_mib=");
  CHECK(words_for("roscell completion ") == "bash fish zsh");
  CHECK(words_for("roscell help rel") == "release");
  CHECK(words_for("roscell form --instances t") == "terminate");
}

TEST_CASE("paths are for the shell to find", "[tools]") {
  CHECK(words_for("roscell request /etc/host") == ":files");
  CHECK(words_for("roscell help --man-pages /us") == ":dirs");
}

TEST_CASE("completion offers nodes, then cells to move them to", "[tools]") {
  CHECK(words_for("roscell transfer ") == "nodes-1");
  CHECK(words_for("roscell transfer arm-1 ") == "cells-1");
  CHECK(words_for("roscell transfer --instances terminate ") == "nodes-1");
  CHECK(words_for("roscell transfer -o json arm-1 ") == "cells-1");
  CHECK(words_for("roscell form arm-1 arm-2 ") == "nodes-1");
  CHECK(words_for("roscell logs ") == "instances-1");
}

TEST_CASE("completion offers a node's secrets, never a value", "[tools]") {
  CHECK(words_for("roscell secret ") == "list remove set");
  CHECK(words_for("roscell secret set ") == "secrets-1");
  CHECK(words_for("roscell secret remove a ") == "secrets-1");
  CHECK(words_for("roscell secret set key --file /etc/host") == ":files");
}

TEST_CASE("no shell gets a name that it could expand", "[tools]") {
  CHECK_FALSE(has(words_for("roscell logs "), "bad"));
}

TEST_CASE("bash puts what is offered behind what is typed", "[tools]") {
  CHECK(offered_by_bash("roscell re", "release\\tmeans\\nrequest\\t\\n")
        == "release request\n");
  CHECK(offered_by_bash("roscell no ''", "") == "\n");
  // Bash makes three words of it.
  CHECK(offered_by_bash("roscell status --output = j", "") == "\n");
  CHECK(
      offered_by_bash("roscell node --capacity m", ":more\\nmemory_mib=\\t\\n")
      == "compopt -o nospace\nmemory_mib=\n");
  CHECK(offered_by_bash("roscell request /etc/hostn", ":files\\n")
        == "compopt -o filenames\n/etc/hostname\n");
}

TEST_CASE("zsh takes its completion script", "[tools]") {
  if (!has_shell("zsh"))
    return;
  CHECK(run_by("zsh -n", completion_script("zsh")).empty());
  // Without its editor zsh completes nothing; what is called is printed.
  CHECK(run_by("zsh -f", "compdef() { }\n_describe() { print -rl -- $found }\n"
                             + with_script("zsh", "a\\tx: y\\nb\\t\\n")
                             + "words=(roscell ''); CURRENT=2; PREFIX=\n"
                               "_roscell 2>/dev/null\n")
        == "a:x: y\nb:\n");
}

TEST_CASE("zsh loads its completion script as a function, too", "[tools]") {
  if (!has_shell("zsh"))
    return;
  const auto folder = scratch_file().string() + ".d";
  fs::create_directory(folder);
  std::ofstream{folder + "/_roscell"} << completion_script("zsh");
  CHECK(run_by("zsh -f", "fpath=(" + folder
                             + ")\nautoload -Uz _roscell\n"
                               "roscell() { print 'a\tb' }\n"
                               "_describe() { print -r -- $found }\n"
                               "words=(roscell ''); CURRENT=2\n_roscell\n")
        == "a:b\n");
  fs::remove_all(folder);
}

TEST_CASE("fish takes its completion script", "[tools]") {
  if (!has_shell("fish"))
    return;
  CHECK(run_by("fish -n", completion_script("fish")).empty());
  CHECK(run_by("fish --no-config",
               with_script("fish", "one\\tx\\n:more\\ntwo\\t\\n")
                   + "complete -C 'roscell transfer ' 2>/dev/null | string "
                     "replace -r '\\t.*' ''\ntrue\n")
        == "one\ntwo\n");
}
