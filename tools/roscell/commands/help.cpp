#include "tools/roscell/commands/help.hpp"

#include "schemas/text_excerpt.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/completion/completer.hpp"
#include "tools/roscell/dashboard/pages.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::cli {

namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char x) { return std::toupper(x); });
  return text;
}

/// In one line, as macros take it.
std::string in_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return roff(text);
}

std::string heading(const std::string& macro, const std::string& title) {
  return "." + macro + " \"" + roff(title) + "\"\n";
}

std::string title_lines(const std::string& name, const std::string& version,
                        std::string what) {
  if (!what.empty() && what.back() == '.')
    what.pop_back();
  return ".TH \"" + roff(upper(name)) + "\" 1 \"\" \"" + roff(version)
         + "\" ROSCell\n" + heading("SH", "NAME") + roff(name) + " \\- "
         + in_one_line(what) + "\n";
}

/// "roscell node [OPTIONS]".
std::string usage(const CLI::App& app, const std::string& called) {
  const auto text = CLI::Formatter{}.make_usage(&app, called);
  return text.substr(text.find(called), text.size() - text.find(called) - 1);
}

std::string option_entry(const CLI::Option& option) {
  const auto name = option.get_positional() ? option.get_name(true)
                                            : joined(names_of(option), ", ");
  const auto& values = option.get_option_text();
  return ".TP\n\\fB" + roff(name) + "\\fR"
         + (values.empty() || values == " " ? "" : " " + roff(values)) + "\n"
         + in_one_line(option.get_description()) + "\n";
}

std::string options(const CLI::App& app) {
  std::string result;
  for (const auto* option : app.get_options())
    result += option_entry(*option);
  return result;
}

/// CLI11 hands footers down to commands that have none.
std::string own_footer(const CLI::App& app) {
  const auto* above = app.get_parent();
  return above != nullptr && above->get_footer() == app.get_footer()
             ? ""
             : app.get_footer();
}

/// A section of a footer begins with a line that ends with a colon; other text
/// is a section of notes. Lines stay what they are.
std::string footer_sections(const CLI::App& app) {
  std::istringstream lines{own_footer(app)};
  std::string result;
  bool is_open = false;
  const auto begin = [&](const std::string& title) {
    result += (is_open ? ".EE\n" : "") + heading("SH", title) + ".EX\n";
    is_open = true;
  };
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line.front() != ' ' && line.back() == ':')
      begin(upper(line.substr(0, line.size() - 1)));
    else if (!line.empty() || is_open) {
      if (!is_open)
        begin("NOTES");
      result += roff(line) + "\n";
    }
  return result + (is_open ? ".EE\n" : "");
}

/// A command below another one, which has no page of its own.
std::string part(const CLI::App& command, const std::string& called) {
  auto text = heading("SS", usage(command, called))
              + in_one_line(command.get_description()) + "\n" + options(command)
              + ".PP\n.EX\n";
  std::istringstream lines{own_footer(command)};
  for (std::string line; std::getline(lines, line);)
    text += roff(line) + "\n";
  return text + ".EE\n";
}

} // namespace

std::string roff(const std::string& text) {
  std::string result;
  for (const char x : text)
    switch (x) {
    case '\\':
      result += "\\e";
      break;
    case '-':
      result += "\\-";
      break;
    case '"':
      result += "\\(dq";
      break;
    case '\'':
      result += "\\(aq";
      break;
    case '`':
      result += "\\(ga";
      break;
    case '^':
      result += "\\(ha";
      break;
    case '~':
      result += "\\(ti";
      break;
    default:
      result += x;
    }
  return !result.empty() && result.front() == '.' ? "\\&" + result : result;
}

std::string program_page(const CLI::App& app) {
  auto page = title_lines("roscell", app.version(), app.get_description())
              + heading("SH", "SYNOPSIS") + roff(usage(app, "roscell")) + "\n"
              + heading("SH", "COMMANDS");
  for (const auto* command : app.get_subcommands({}))
    page += ".TP\n\\fBroscell\\-" + roff(command->get_name()) + "\\fR(1)\n"
            + in_one_line(command->get_description()) + "\n";
  return page + heading("SH", "OPTIONS") + options(app) + footer_sections(app);
}

std::string command_page(const CLI::App& app, const CLI::App& command) {
  const auto called = "roscell " + command.get_name();
  auto page = title_lines("roscell-" + command.get_name(), app.version(),
                          command.get_description())
              + heading("SH", "SYNOPSIS") + roff(usage(command, called)) + "\n"
              + heading("SH", "OPTIONS") + options(command);
  const auto below = command.get_subcommands([](const auto*) { return true; });
  if (!below.empty())
    page += heading("SH", "COMMANDS");
  for (const auto* x : below)
    page += part(*x, called + " " + x->get_name());
  return page + footer_sections(command) + heading("SH", "SEE ALSO")
         + "\\fBroscell\\fR(1)\n";
}

namespace {

/// Where it is told how a command is used.
std::string help_of(const CLI::App& command) {
  return command.get_parent() == nullptr
             ? "`roscell --help` lists the commands"
             : "`roscell " + command.get_name()
                   + " --help` shows how it is used";
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> result;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames())
      result.push_back("--" + name);
    for (const auto& name : option->get_snames())
      result.push_back("-" + name);
  }
  return result;
}

std::string_view closest(std::string_view typed,
                         const std::vector<std::string>& words) {
  return closest_word(typed, {words.begin(), words.end()});
}

command_error no_option(const CLI::App& command, const std::string& word) {
  const auto name = word.substr(0, word.find('='));
  const auto words = options_of(command);
  const auto meant = closest(name, words);
  return {exit_usage,
          (command.get_parent() == nullptr
               ? "there is no option "
               : "`roscell " + command.get_name() + "` has no option ")
              + name,
          meant.empty() ? help_of(command)
                        : "did you mean " + std::string{meant} + "?"};
}

/// A word that fits nowhere.
command_error misplaced(const CLI::App& app, const CLI::App& command,
                        const std::string& word) {
  if (word.size() > 1 && word.front() == '-')
    return no_option(command, word);
  if (&command == &app)
    return no_command(app, word);
  return {exit_usage,
          "'" + word + "' is one argument too many for `roscell "
              + command.get_name() + "`",
          help_of(command)};
}

} // namespace

command_error no_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands({}))
    names.push_back(command->get_name());
  const auto meant = closest(name, names);
  return {exit_usage, "there is no command '" + name + "'",
          meant.empty() ? help_of(app)
                        : "did you mean `roscell " + std::string{meant} + "`?"};
}

command_error usage_error(const CLI::App& app, const CLI::ParseError& why) {
  const auto chosen = app.get_subcommands();
  const auto& command = chosen.empty() ? app : *chosen.back();
  // What is left over may be why something else is missing.
  if (const auto rest = app.remaining(true); !rest.empty())
    return misplaced(app, command, rest.front());
  if (chosen.empty())
    return {exit_usage, "a command is missing", help_of(app)};
  return {exit_usage, why.what(), help_of(command)};
}

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
