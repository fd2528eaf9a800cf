#include "tools/roscell/config/node_source.hpp"

#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/config/config_file.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

/// What a node that runs can take.
constexpr std::array<std::string_view, 6> live_options{
    "cpu-floor", "device", "drain-timeout", "label", "log-level", "skills"};

bool is_live_option(const std::string& option) {
  return std::find(live_options.begin(), live_options.end(), option)
         != live_options.end();
}

given_options given_in(CLI::App& command) {
  given_options result;
  for (const auto* option : options_of_file(command))
    if (option->count() > 0)
      result[option->get_lnames().front()] = option->results();
  return result;
}

void give(CLI::App& command, const given_options& given) {
  for (auto* option : options_of_file(command)) {
    const auto found = given.find(option->get_lnames().front());
    if (found == given.end())
      continue;
    for (const auto& value : found->second)
      option->add_result(value);
    option->run_callback();
  }
}

/// The line that an error is about, which names its option and maybe its value;
/// 0: none of the file.
size_t line_of(const std::vector<config_line>& lines, const std::string& why) {
  size_t result = 0;
  for (const auto& x : lines) {
    if (why.rfind("--" + x.key, 0) != 0)
      continue;
    if (why.find(x.value) != std::string::npos)
      return x.number;
    result = x.number;
  }
  return result;
}

/// What is wrong with an option names its line, if it is the file that has it.
command_error placed_in(const std::filesystem::path& file,
                        const given_options& by_command,
                        const command_error& why) {
  const std::string text = why.what();
  const auto name = file.string();
  auto lines = parse_config(name, read_file(name, max_config_bytes));
  lines.erase(std::remove_if(
                  lines.begin(), lines.end(),
                  [&](const auto& x) { return by_command.count(x.key) > 0; }),
              lines.end());
  const auto number = line_of(lines, text);
  return number == 0
             ? why
             : command_error{why.code,
                             name + ":" + std::to_string(number) + ": " + text,
                             why.hint};
}

} // namespace

node_source::node_source(CLI::App& command, std::filesystem::path file)
    : given_{given_in(command)}, file_{std::move(file)} {
  // The node may be elsewhere when it reads the file again.
  if (!file_.empty())
    file_ = std::filesystem::absolute(file_);
}

node_reading node_source::read() const {
  node_reading result;
  CLI::App command{"", "node"};
  add_node_options(command, result.options);
  give(command, given_);
  if (!file_.empty())
    take_config(command, file_);
  result.given = given_in(command);
  try {
    to_config(result.options);
  } catch (const command_error& why) {
    if (file_.empty())
      throw;
    throw placed_in(file_, given_, why);
  }
  return result;
}

option_changes option_changes_between(const given_options& in_use,
                                      const given_options& read) {
  std::set<std::string> names;
  for (const auto* given : {&in_use, &read})
    for (const auto& [name, values] : *given)
      names.insert(name);
  const auto values_in = [](const given_options& given,
                            const std::string& name) {
    const auto found = given.find(name);
    return found == given.end() ? std::vector<std::string>{} : found->second;
  };
  option_changes result;
  for (const auto& name : names) {
    if (values_in(in_use, name) == values_in(read, name))
      continue;
    result.changed.push_back(name);
    if (!is_live_option(name))
      result.needs_restart.push_back(name);
  }
  return result;
}

given_options in_use_after(const given_options& in_use,
                           const given_options& read) {
  given_options result;
  for (const auto& [name, values] : in_use)
    if (!is_live_option(name))
      result[name] = values;
  for (const auto& [name, values] : read)
    if (is_live_option(name))
      result[name] = values;
  return result;
}

} // namespace roscell::cli
