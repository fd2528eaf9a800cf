#include "actors/builds/limits.hpp"
#include "messages/skill.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/cell_skills.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace roscell::cli {

namespace {

struct add_options {
  connection_options connection;
  std::string output = "table";
  std::string source; ///< A folder, or an archive.
};

std::string names_in_words(const std::vector<std::string>& names) {
  std::string result;
  for (const auto& x : names)
    result += (result.empty() ? "'" : ", '") + printable(x) + "'";
  return result;
}

std::string added_text(const cell_build& x) {
  return "skill '" + printable(x.skill.descriptor.operation) + "', version "
         + printable(x.skill.version.substr(0, limits::build::shown_digits))
         + ", build " + x.build.hash.substr(0, limits::build::shown_digits)
         + ", is one of the cell's; kept on " + names_in_words(x.keepers)
         + "\n";
}

int add_skill(const add_options& options) {
  const node_client node{options.connection};
  const auto reply =
      add_to_cell(node, options.source, "", options.output == "json");
  print(options.output == "json" ? pretty(reply)
                                 : added_text(reply.get<skill_added>().added));
  return exit_done;
}

struct remove_options {
  connection_options connection;
  std::string output = "table";
  skill_removal request;
};

int remove_skill(const remove_options& options) {
  const node_client node{options.connection};
  const auto reply = unless_refused(
      node.post("/v1/requests", message_json(options.request).dump(),
                limits::build::disk),
      options.output == "json");
  if (options.output == "json") {
    print(pretty(reply));
    return exit_done;
  }
  for (const auto& x : reply.get<skill_removed>().removed)
    print("build " + x.build.hash.substr(0, limits::build::shown_digits)
          + " of '" + printable(x.skill.descriptor.operation)
          + "' is none of the cell's skills any more\n");
  return exit_done;
}

} // namespace

void add_skill_add_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<add_options>();
  auto* command = skills.add_subcommand(
      "add", "Add a skill to the cell, for every node that needs it.");
  command->footer(
      "The build goes to the node that is asked, to the coordination node and "
      "to a second one, where\nit stays. Each node on which a step of it is "
      "placed fetches it from those that have it.\nThe same folder again "
      "changes nothing; what has come of it before is not sent again.\n\n"
      "Examples:\n  roscell skill add build/skills/shout\n  roscell skill add "
      "shout-1.2.tar.gz");
  command
      ->add_option("FOLDER|ARCHIVE", options->source,
                   "The ready skill, skill.json and what it names, as it lies "
                   "in a folder or is packed as tar or zip")
      ->required()
      ->option_text(" ");
  add_output_option(*command, options->output);
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return add_skill(*options); };
  });
}

void add_skill_remove_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<remove_options>();
  auto* command = skills.add_subcommand(
      "remove", "Remove a skill from the cell's, unless it runs.");
  command->footer("Folders of skills that lie on nodes stay as they are.\n\n"
                  "Examples:\n  roscell skill remove shout\n"
                  "  roscell skill remove shout --build 3f9a1c04b7d2");
  command->add_option("OPERATION", options->request.operation, "What it does")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--build", options->request.build,
                   "Only this build: the first 8 or more digits of its hash")
      ->option_text("DIGITS");
  add_output_option(*command, options->output);
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return remove_skill(*options); };
  });
}

} // namespace roscell::cli
