#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/top/viewer.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <map>
#include <memory>
#include <set>
#include <string>

namespace roscell::cli {

namespace {

struct top_options {
  connection_options connection;
  std::string sort; ///< By this column, from its end if "-" is before it.
  std::string filter;
};

void require_terminal() {
  if (!stdout_is_terminal() || isatty(STDIN_FILENO) != 1)
    throw command_error{exit_usage,
                        "`roscell top` needs a terminal for its input and "
                        "its output",
                        "`roscell nodes`, `roscell tasks` and `roscell "
                        "instances` print the same; -o json is for programs"};
}

[[noreturn]] void refuse_column(const std::string& name) {
  std::vector<std::string> names;
  std::set<std::string> reported;
  for (const auto& x : top::all_lists({}, 0))
    for (const auto& c : x.columns)
      if (reported.insert(c.name).second)
        names.push_back(c.name);
  throw command_error{exit_usage, "there is no column '" + name + "'",
                      "the columns are " + joined(names, ", ")};
}

/// Scripts may still say a column as earlier versions of this major one did.
std::string present_name(const std::string& name) {
  static const std::map<std::string, std::string> names{
      {"drops", "dropped"}, {"id", "instance"}, {"instance-of", "task"}};
  const auto found = names.find(name);
  return found == names.end() ? name : found->second;
}

/// Each list that has the column is sorted by it.
void sort_by(const std::string& sort, top::controls& begin) {
  if (sort.empty())
    return;
  const bool backwards = sort.front() == '-';
  const auto name = present_name(sort.substr(backwards ? 1 : 0));
  const auto lists = top::all_lists({}, 0);
  bool found = false;
  for (size_t i = 0; i < lists.size(); ++i)
    if (const auto column = column_of(lists.at(i), name)) {
      begin.lists.at(i).order = {lists.at(i).columns[*column].name, backwards};
      found = true;
    }
  if (!found)
    refuse_column(name);
}

int show_top(const top_options& options) {
  top::controls begin;
  begin.filter = options.filter;
  sort_by(options.sort, begin);
  require_terminal();
  const node_client node{options.connection};
  // Who cannot ask at all is told so before the screen is taken.
  node.get("/v1/node");
  top::viewer{node, begin}.run();
  return exit_done;
}

} // namespace

void add_top_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<top_options>();
  auto* command = app.add_subcommand(
      "top", "Show nodes, tasks and instances on a full screen, live.");
  command->footer("? lists the keys, q ends.\n\n"
                  "Examples:\n  roscell top\n"
                  "  roscell top --sort=-rate --filter arm-1\n"
                  "  roscell top --to 192.168.1.10 --token-file token");
  add_connection_options(*command, options->connection);
  command
      ->add_option("--sort", options->sort,
                   "Begin with the lists sorted by this column, numbers by "
                   "their value; --sort=-COLUMN from its end")
      ->option_text("COLUMN");
  command
      ->add_option("--filter", options->filter,
                   "Begin with what contains this text, in any case")
      ->option_text("TEXT");
  command->callback([&chosen, options] {
    chosen = [options] { return show_top(*options); };
  });
}

} // namespace roscell::cli
