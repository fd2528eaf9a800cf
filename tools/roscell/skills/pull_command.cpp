#include "actors/builds/limits.hpp"
#include "messages/skill.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/cell_skills.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace roscell::cli {

namespace {

struct pull_options {
  connection_options connection;
  std::string output = "table";
  std::string folder; ///< Empty: named after the operation.
  skill_pull request;
};

int pull_skill(const pull_options& options) {
  const node_client node{options.connection};
  const auto folder =
      options.folder.empty() ? options.request.operation : options.folder;
  const auto reply =
      pull_from_cell(node, options.request.operation, options.request.build,
                     folder, options.output == "json");
  const auto pulled = reply.get<skill_pulled>().pulled;
  print(options.output == "json"
            ? pretty(reply)
            : "build "
                  + pulled.build.hash.substr(0, limits::build::shown_digits)
                  + " of '" + printable(options.request.operation) + "' is in '"
                  + printable(folder) + "'\n");
  return exit_done;
}

} // namespace

void add_skill_pull_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<pull_options>();
  auto* command = skills.add_subcommand(
      "pull", "Copy a skill of the cell into a folder of this machine.");
  command->footer("The node that is asked fetches it first, if it lacks it.\n\n"
                  "Examples:\n  roscell skill pull shout\n"
                  "  roscell skill pull shout --build 3f9a1c04b7d2 --into old");
  command->add_option("OPERATION", options->request.operation, "What it does")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--build", options->request.build,
                   "This build, not the newest: the first 8 or more digits of "
                   "its hash")
      ->option_text("DIGITS");
  command
      ->add_option("--into", options->folder,
                   "The folder that is made; default: named after OPERATION")
      ->option_text("FOLDER");
  add_output_option(*command, options->output);
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return pull_skill(*options); };
  });
}

} // namespace roscell::cli
