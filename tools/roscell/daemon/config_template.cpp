#include "tools/roscell/daemon/config_template.hpp"

#include "tools/roscell/commands.hpp"
#include "tools/roscell/daemon/config_file.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <sstream>

namespace roscell::cli {

namespace {

constexpr size_t widest_line = 78;

constexpr auto heading =
    R"(# What this node is started with. A line is `OPTION = VALUE`, with the long name
# of an option of `roscell node` (`man roscell-node`); # begins a comment. Paths
# begin in the folder of this file. After a change: systemctl restart roscell
)";

/// `text` as comments, in lines that a terminal shows whole.
std::string comment(const std::string& text) {
  std::istringstream words{text};
  std::string lines;
  std::string line = "#";
  for (std::string word; words >> word; line += " " + word)
    if (line.size() + 1 + word.size() > widest_line) {
      lines += line + "\n";
      line = "#";
    }
  return lines + line + "\n";
}

/// The option with its values, and its default: "PORT [8420]".
std::string entry(const CLI::Option& option) {
  const auto& text = option.get_option_text();
  const auto values = text.substr(0, text.find(" ["));
  const auto rest = text.substr(values.size());
  return "\n" + comment(option.get_description() + rest) + "#"
         + option.get_lnames().front() + " = "
         + (values.empty() ? "true" : values) + "\n";
}

} // namespace

std::string config_template(CLI::App& command) {
  std::string result = heading;
  for (const auto* option : options_of_file(command))
    result += entry(*option);
  return result;
}

void add_new_config_command(CLI::App& app, CLI::App& parent, action& chosen) {
  auto* command = parent.add_subcommand(
      "config", "Print a file for `roscell node --config`, with every option.");
  command->footer("Examples:\n  roscell new config > /etc/roscell/node.conf");
  command->callback([&app, &chosen] {
    chosen = [&app] {
      print(config_template(*app.get_subcommand("node")));
      return exit_done;
    };
  });
}

} // namespace roscell::cli
