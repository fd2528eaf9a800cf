#include "tools/roscell/config/node_source.hpp"

#include "test/temp_folder.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <optional>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::cli;
using namespace roscell::test;

namespace {

/// A node that was started with words of a command line, and a file.
struct started_node {
  explicit started_node(const std::string& words) {
    CLI::App app;
    auto* command = app.add_subcommand("node", "");
    node_options options;
    add_node_options(*command, options);
    app.parse("node " + words);
    source.emplace(*command, folder.path() / "node.conf");
  }

  node_reading read(const std::string& text) const {
    folder.write("node.conf", text);
    return source->read();
  }

  std::string refusal(const std::string& text) const {
    try {
      read(text);
      return {};
    } catch (const command_error& why) {
      return why.what();
    }
  }

  temp_folder folder;
  std::optional<node_source> source;
};

using names = std::vector<std::string>;

} // namespace

TEST_CASE("a file that has changed is read again, after the command line",
          "[tools]") {
  const started_node node{"--label room=lab --no-rebalance --coordinator"};
  const auto first = node.read("label = room=hall\nport = 8421\n");
  CHECK(first.options.labels == names{"room=lab"});
  CHECK(first.options.config.http_port == 8421);
  CHECK_FALSE(first.options.config.rebalance);
  CHECK(first.options.config.coordinator);
  const auto second = node.read("port = 8422\nskills = more\n");
  CHECK(second.options.labels == names{"room=lab"});
  CHECK(second.options.config.http_port == 8422);
  REQUIRE(second.options.skill_dirs.size() == 1);
  CHECK(second.options.skill_dirs[0] == node.folder.path() / "more");
}

TEST_CASE("what needs a restart is named until there is one", "[tools]") {
  const started_node node{""};
  const auto first = node.read("label = room=lab\nport = 8421\n");
  const auto second = node.read("label = room=hall\nport = 8422\n");
  const auto changes = option_changes_between(first.given, second.given);
  CHECK(changes.changed == names{"label", "port"});
  CHECK(changes.needs_restart == names{"port"});
  const auto in_use = in_use_after(first.given, second.given);
  const auto again = option_changes_between(in_use, second.given);
  CHECK(again.changed == names{"port"});
  CHECK(again.needs_restart == names{"port"});
  const auto back = option_changes_between(
      in_use, node.read("label = room=hall\nport = 8421\n").given);
  CHECK(back.changed.empty());
}

TEST_CASE("what is left out of a file has changed, too", "[tools]") {
  const started_node node{""};
  const auto first = node.read("label = room=lab\n");
  const auto changes =
      option_changes_between(first.given, node.read("# none\n").given);
  CHECK(changes.changed == names{"label"});
  CHECK(changes.needs_restart.empty());
}

TEST_CASE("an error that is the file's names its line", "[tools]") {
  const started_node node{"--log-bytes 1KiB"};
  const auto file = node.folder / "node.conf";
  CHECK(node.refusal("label = a=1\n\nlabel = b\n")
            .rfind(file + ":3: --label: 'b'", 0)
        == 0);
  CHECK(node.refusal("\ndevice = /dev/none-such\n")
            .rfind(file + ":2: --device: there is no", 0)
        == 0);
  CHECK(node.refusal("port = many\n").rfind(file + ":1: ", 0) == 0);
  // This one is the command line's.
  CHECK(node.refusal("log-bytes = 1MiB\n").rfind("--log-bytes: ", 0) == 0);
}
