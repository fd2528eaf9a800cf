#include "tools/roscell/commands/manual.hpp"

#include "tools/roscell/completion/option_values.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

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

} // namespace roscell::cli
