#include "actors/instances/skill_catalogue.hpp"
#include "tools/roscell/client/read_file.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace roscell::cli {

namespace {

struct check_options {
  std::string folder;
  std::string architecture = own_architecture();
  bool for_containers = false;
};

/// The problem, and where it is in the descriptor.
std::string problem_view(const skill_problem& problem) {
  auto text =
      printable(problem.path) + ": " + printable(problem.message) + "\n";
  if (!problem.where.empty())
    text += marked_place(problem.path, read_file(problem.path), problem.where);
  return text;
}

int check_skill(const check_options& options) {
  std::error_code error;
  if (!std::filesystem::is_directory(options.folder, error))
    throw command_error{exit_usage,
                        "'" + printable(options.folder) + "' is no folder",
                        "name the folder that holds skill.json"};
  const auto found = skill_catalogue::of_folder(
      options.folder, {options.architecture, !options.for_containers});
  for (const auto& x : found.problems())
    print_text(problem_view(x));
  if (!found.problems().empty())
    return exit_refused;
  constexpr size_t short_hash = 12;
  const auto skill = found.skills().front();
  print("nothing is wrong with skill '" + printable(skill.descriptor.operation)
        + "', build " + skill.hash.substr(0, short_hash) + ", for "
        + options.architecture + "\n");
  return exit_done;
}

} // namespace

void add_skill_check_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<check_options>();
  auto* command = skills.add_subcommand(
      "check", "Say everything that keeps a node from running a skill.");
  command->footer(
      "Looks at the descriptor, and whether its program is there, can be run, "
      "is for the machine,\nand finds its shared libraries. Nothing is "
      "started. A node refuses such a skill when it\nstarts, and `roscell "
      "skills` shows why.\n\n"
      "Examples:\n  roscell skill check build/skills/shout\n"
      "  roscell skill check --architecture arm64 build-arm64/skills/shout");
  command
      ->add_option("FOLDER", options->folder,
                   "The ready skill: skill.json and what it names")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--architecture", options->architecture,
                   "What the node is that shall run it; libraries are looked "
                   "for only if it is this host's")
      ->option_text("ARCH [" + options->architecture + "]");
  command->add_flag("--for-containers", options->for_containers,
                    "The C library and interpreters are the image's");
  command->callback([&chosen, options] {
    chosen = [options] { return check_skill(*options); };
  });
}

} // namespace roscell::cli
