#include "tools/roscell/commands/completion.hpp"

#include "tools/roscell/commands.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

using namespace roscell::cli;

namespace {

std::string script() {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  return bash_completion(app);
}

/// What a shell with the script offers after `words`; `roscell` itself is
/// replaced by a function that prints `table`.
std::string offered(const std::string& words, const std::string& table = "") {
  const auto file = std::filesystem::temp_directory_path()
                    / ("roscell-completion-" + std::to_string(getpid()));
  std::ofstream{file}
      << script() << "roscell() { printf '%s' '" << table << "'; }\n"
      << "compopt() { :; }\n"
      << "COMP_WORDS=(" << words << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
      << "COMP_LINE=\"${COMP_WORDS[*]}\"\n_roscell\necho \"${COMPREPLY[*]}\"\n";
  const auto command = "bash -u " + file.string() + " 2>&1";
  auto* out = popen(command.c_str(), "r");
  REQUIRE(out != nullptr);
  std::string text;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), out) != nullptr)
    text += buffer.data();
  CHECK(pclose(out) == 0);
  std::filesystem::remove(file);
  return text;
}

} // namespace

TEST_CASE("completion offers every command", "[tools]") {
  CHECK(offered("roscell ''")
        == "node request plan form transfer release status cells nodes tasks "
           "instances skills transfers events logs completion --version "
           "--help\n");
  CHECK(offered("roscell no") == "node nodes\n");
}

TEST_CASE("completion offers a command's options", "[tools]") {
  CHECK(offered("roscell status --a") == "--actors\n");
  CHECK(offered("roscell node --da") == "--data-dir\n");
}

TEST_CASE("completion offers the values of an option", "[tools]") {
  CHECK(offered("roscell status -o ''") == "table json\n");
  CHECK(offered("roscell node --runtime po") == "podman\n");
  CHECK(offered("roscell node --interface l") == "lo\n");
  CHECK(offered("roscell completion ''") == "bash\n");
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
