#include "tools/roscell/commands.hpp"
#include "tools/roscell/commands/manual.hpp"
#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/usage_error.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

namespace roscell::cli {

namespace {

const CLI::App& command_of(const CLI::App& app, const std::string& name) {
  const auto found = app.get_subcommands(
      [&](const CLI::App* x) { return x->get_name() == name; });
  if (found.empty())
    throw no_command(app, name);
  return *found.front();
}

/// The help of a command; of the whole program if none is named. The program's
/// own help would be that of the command that was parsed.
int show_help(const CLI::App& app, const std::string& name) {
  const auto& command = name.empty() ? app : command_of(app, name);
  const auto called =
      name.empty() ? app.get_name() : app.get_name() + " " + name;
  print(command.get_formatter()->make_help(&command, called,
                                           CLI::AppFormatMode::Normal));
  return exit_done;
}

void write_page(const std::filesystem::path& file, const std::string& page) {
  std::ofstream out{file};
  out << page;
  if (!out.flush())
    throw command_error{exit_usage, "cannot write " + file.string()};
}

int write_manual(const CLI::App& app, const std::filesystem::path& folder) {
  write_page(folder / "roscell.1", program_page(app));
  for (const auto* command : app.get_subcommands({}))
    write_page(folder / ("roscell-" + command->get_name() + ".1"),
               command_page(app, *command));
  return exit_done;
}

} // namespace

void add_help_commands(CLI::App& app, action& chosen) {
  auto name = std::make_shared<std::string>();
  auto folder = std::make_shared<std::filesystem::path>();
  auto* help = app.add_subcommand("help", "Explain a command.");
  help->footer("Examples:\n  roscell help\n  roscell help node");
  help->add_option("COMMAND", *name, "The command; none: all of them")
      ->option_text(" ");
  help->add_option("--man-pages", *folder,
                   "Write the manual pages of all commands to this folder")
      ->option_text("DIR");
  auto described = std::make_shared<bool>(false);
  help->add_flag("--described", *described,
                 "Print what the dashboard is told of columns and events");
  help->callback([&app, &chosen, name, folder, described] {
    chosen = [&app, name, folder, described] {
      if (*described) {
        print(described_script());
        return static_cast<int>(exit_done);
      }
      return folder->empty() ? show_help(app, *name)
                             : write_manual(app, *folder);
    };
  });
  auto* version = app.add_subcommand("version", "Print the version.");
  version->callback([&app, &chosen] {
    chosen = [&app] {
      print(app.version() + "\n");
      return exit_done;
    };
  });
}

} // namespace roscell::cli
