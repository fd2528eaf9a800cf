#include "tools/roscell/config/config_file.hpp"

#include "schemas/text_excerpt.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/completion/completer.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <sstream>
#include <string_view>

namespace roscell::cli {

namespace {

constexpr auto blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == text.npos)
    return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view without_comment(std::string_view line) {
  for (auto i = line.find('#'); i != line.npos; i = line.find('#', i + 1))
    if (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')
      return line.substr(0, i);
  return line;
}

command_error wrong_line(const std::string& name, size_t number,
                         const std::string& what, std::string hint = {}) {
  return {exit_usage,
          printable(name) + ":" + std::to_string(number) + ": "
              + printable(what),
          std::move(hint)};
}

config_line parse_line(const std::string& name, size_t number,
                       std::string_view line) {
  const auto equals = line.find('=');
  const auto key = trimmed(line.substr(0, equals));
  const auto value =
      equals == line.npos ? "" : trimmed(line.substr(equals + 1));
  if (key.empty())
    throw wrong_line(name, number, "there is no key before '='",
                     "a line is `key = value`");
  if (value.empty())
    throw wrong_line(name, number, "'" + std::string{key} + "' has no value",
                     "a line is `key = value`, of an option without a value "
                     "`key = true`");
  return {number, std::string{key}, std::string{value}};
}

CLI::Option& option_for(CLI::App& command, const std::string& name,
                        const config_line& line) {
  std::vector<std::string> keys;
  for (auto* option : options_of_file(command)) {
    if (option->check_lname(line.key))
      return *option;
    keys.push_back(option->get_lnames().front());
  }
  const auto meant = closest_word(line.key, {keys.begin(), keys.end()});
  throw wrong_line(name, line.number, "there is no option '" + line.key + "'",
                   meant.empty()
                       ? "`roscell " + command.get_name()
                             + " --help` lists them; a key is an "
                               "option's long name without dashes"
                       : "did you mean '" + std::string{meant} + "'?");
}

bool can_be_repeated(const CLI::Option& option) {
  return option.get_items_expected_max() > 1;
}

/// What the option gets; the shell's folder means nothing to a file.
std::string value_for(const CLI::Option& option, const std::string& value,
                      const std::filesystem::path& folder) {
  const auto kind = action_of(option);
  return kind == "files" || kind == "dirs" ? (folder / value).string() : value;
}

} // namespace

std::vector<config_line> parse_config(const std::string& name,
                                      const std::string& text) {
  std::vector<config_line> result;
  std::istringstream lines{text};
  std::string line;
  for (size_t number = 1; std::getline(lines, line); ++number)
    if (const auto said = trimmed(without_comment(line)); !said.empty())
      result.push_back(parse_line(name, number, said));
  return result;
}

std::vector<CLI::Option*> options_of_file(CLI::App& command) {
  return command.get_options([](const CLI::Option* option) {
    return !option->check_lname("help") && !option->check_lname("config");
  });
}

void take_config(CLI::App& command, const std::filesystem::path& file) {
  const auto name = file.string();
  const auto folder = std::filesystem::absolute(file).parent_path();
  std::map<CLI::Option*, size_t> lines;
  std::vector<std::pair<CLI::Option*, config_line>> wanted;
  for (auto& line : parse_config(name, read_file(name, max_config_bytes))) {
    auto& option = option_for(command, name, line);
    const auto [first, is_new] = lines.emplace(&option, line.number);
    if (!is_new && !can_be_repeated(option))
      throw wrong_line(name, line.number,
                       "'" + line.key + "' is in line "
                           + std::to_string(first->second) + " already",
                       "leave out one of them");
    if (option.count() == 0)
      wanted.emplace_back(&option, std::move(line));
  }
  for (auto& [option, line] : wanted)
    try {
      option->add_result(value_for(*option, line.value, folder));
      option->run_callback();
    } catch (const CLI::Error& e) {
      throw wrong_line(name, line.number, e.what());
    }
}

namespace {

constexpr size_t widest_line = 78;

constexpr auto heading =
    R"(# What this node is started with. A line is `OPTION = VALUE`, with the long name
# of an option of `roscell node` (`man roscell-node`); # begins a comment. Paths
# begin in the folder of this file. After a change: systemctl reload roscell,
# which says what needs a restart
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
