#include "tools/roscell/config/config_file.hpp"

#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

#include <unistd.h>

using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

/// A command with an option of each kind, and its file.
struct fixture {
  fs::path folder = fs::temp_directory_path()
                    / ("roscell-config-" + std::to_string(getpid()));
  fs::path file = folder / "node.conf";
  CLI::App app;
  CLI::App& command = *app.add_subcommand("node");
  std::string name = "none";
  int port = 8420;
  bool coordinator = false;
  bool rebalance = true;
  std::vector<std::string> labels;
  std::vector<fs::path> skills;
  fs::path token;

  fixture() {
    fs::create_directories(folder);
    command.add_option("--config", file);
    command.add_option("--name", name);
    command.add_option("--port", port)->check(CLI::Range(0, 65535));
    command.add_flag("--coordinator", coordinator);
    command.add_flag_callback("--no-rebalance", [this] { rebalance = false; });
    command.add_option("--label", labels)->allow_extra_args(false);
    command.add_option("--skills", skills)->allow_extra_args(false);
    command.add_option("--site-token", token);
  }

  ~fixture() {
    fs::remove_all(folder);
  }

  fixture(const fixture&) = delete;
  fixture& operator=(const fixture&) = delete;

  /// Reads the command line, then the file.
  void take(const std::string& text, const std::string& words = "") {
    std::ofstream{file} << text;
    app.parse("node " + words);
    take_config(command, file);
  }

  /// What is said of the file, behind its path, and the hint.
  std::string refusal(const std::string& text) {
    try {
      take(text);
      return {};
    } catch (const command_error& e) {
      CHECK(e.code == exit_usage);
      const auto what = std::string{e.what()};
      CHECK(what.find(file.string()) != what.npos);
      return what.substr(what.find(file.string()) + file.string().size())
             + " | " + e.hint;
    }
  }
};

} // namespace

TEST_CASE_METHOD(fixture, "a file says what options say", "[tools]") {
  take("# A node.\n\n  name = arm \nport=8421\t# not the usual one\r\n"
       "coordinator = true\nno-rebalance = yes\n"
       "label = room=lab\nlabel = colour=#fff\n");
  CHECK(name == "arm");
  CHECK(port == 8421);
  CHECK(coordinator);
  CHECK_FALSE(rebalance);
  CHECK(labels == std::vector<std::string>{"room=lab", "colour=#fff"});
}

TEST_CASE_METHOD(fixture, "an option that is off in a file stays off",
                 "[tools]") {
  take("coordinator = false\nno-rebalance = no\n");
  CHECK_FALSE(coordinator);
  CHECK(rebalance);
}

TEST_CASE_METHOD(fixture, "the command line comes before the file", "[tools]") {
  take("name = arm\nport = 1\nlabel = a=1\nlabel = b=2\ncoordinator = false\n",
       "--name belt --label c=3 --coordinator");
  CHECK(name == "belt");
  CHECK(port == 1);
  CHECK(labels == std::vector<std::string>{"c=3"});
  CHECK(coordinator);
}

TEST_CASE_METHOD(fixture, "paths of a file begin in its folder", "[tools]") {
  take("site-token = site.token\nskills = /opt/skills\nskills = mine\n"
       "name = site.token\n");
  CHECK(token == folder / "site.token");
  CHECK(skills == std::vector<fs::path>{"/opt/skills", folder / "mine"});
  CHECK(name == "site.token");
}

TEST_CASE_METHOD(fixture, "an unknown key is named with the nearest one",
                 "[tools]") {
  CHECK(refusal("name = a\n\nsite_token = x\n")
        == ":3: there is no option 'site_token' | did you mean 'site-token'?");
  CHECK(refusal("quite different = x\n").find("roscell node --help")
        != std::string::npos);
  CHECK(refusal("help = true\n").find(":1: there is no option 'help'") == 0);
  CHECK(refusal("config = other\n").find(":1: there is no option") == 0);
  CHECK(refusal("nam\x1b[2J = x\n").find(":1: there is no option 'nam?[2J'")
        == 0);
}

TEST_CASE_METHOD(fixture, "a line that is no key and value is refused",
                 "[tools]") {
  CHECK(refusal("coordinator\n").find(":1: 'coordinator' has no value") == 0);
  CHECK(refusal("name = # arm\n").find(":1: 'name' has no value") == 0);
  CHECK(refusal("= arm\n").find(":1: there is no key") == 0);
}

TEST_CASE_METHOD(fixture, "a value that the option does not take is refused",
                 "[tools]") {
  CHECK(refusal("\nport = 65536\n").find(":2: --port: ") == 0);
  CHECK(refusal("port = many\n").find(":1: ") == 0);
  CHECK(refusal("coordinator = perhaps\n").find(":1: ") == 0);
}

TEST_CASE_METHOD(fixture, "only what can be repeated stands twice in a file",
                 "[tools]") {
  CHECK(refusal("name = a\nport = 1\nname = a\n")
            .find(":3: 'name' is in line 1 already")
        == 0);
  CHECK(refusal("coordinator = true\ncoordinator = true\n").find(":2: ") == 0);
}

TEST_CASE_METHOD(fixture, "a file that is not there or too large is refused",
                 "[tools]") {
  CHECK_FALSE(refusal(std::string(64 * 1024, '#')).size());
  CHECK(refusal(std::string(64 * 1024 + 1, '#')).find(" is larger than 64 KiB")
        == 0);
  app.clear();
  CHECK_THROWS_AS(take_config(command, folder / "other.conf"), command_error);
}

TEST_CASE("the file to begin with has every option of a node", "[tools]") {
  CLI::App app;
  action chosen;
  set_up(app, chosen);
  auto& node = *app.get_subcommand("node");
  const auto text = config_template(node);
  CHECK(parse_config("node.conf", text).empty());
  std::string uncommented;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 1 && line[0] == '#' && line[1] != ' ')
      uncommented += line.substr(1) + "\n";
  std::vector<CLI::Option*> named;
  for (const auto& x : parse_config("node.conf", uncommented)) {
    named.push_back(node.get_option_no_throw("--" + x.key));
    CHECK(x.value.find(" [") == std::string::npos);
  }
  CHECK(named == options_of_file(node));
}
