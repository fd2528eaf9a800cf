#include "actors/edge/process/skill_grants.hpp"
#include "actors/instances/skills/skill_catalogue.hpp"
#include "messages/node.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <variant>

namespace roscell::cli {

namespace {

struct check_options {
  std::string folder;
  connection_options connection;
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

bool names_a_node(const check_options& options) {
  return !options.connection.to.empty() || std::getenv("ROSCELL_TO") != nullptr;
}

/// Says what of a skill's requests the node does not grant. Returns whether it
/// can run any deployment all the same.
bool check_grants(const check_options& options, const skill_descriptor& skill) {
  const auto node =
      node_client{options.connection}.get("/v1/node").get<node_description>();
  const auto read = skill_grants::parse(node.resources.grants);
  const auto* known = std::get_if<skill_grants>(&read);
  const auto granted = known != nullptr ? *known : skill_grants{};
  bool can_run = false;
  for (const auto& model : skill.models)
    for (const auto& option : model.deployments) {
      const auto missing = granted.missing(skill.operation, option);
      can_run = can_run || missing.empty();
      for (const auto& what : missing)
        print_text(
            "model '" + printable(model.name) + "', deployment '"
            + printable(option.name) + "': "
            + printable(refusal_text(skill.operation, node.identity.name, what))
            + "\n");
    }
  return can_run;
}

/// What a node has to be told before it runs the skill.
void print_requirements(const skill_descriptor& skill) {
  for (const auto& model : skill.models)
    for (const auto& option : model.deployments)
      for (const auto& what : skill_grants{}.missing(skill.operation, option))
        print_note("deployment '" + printable(option.name) + "' of model '"
                   + printable(model.name)
                   + "' runs where node.conf has: grant = "
                   + printable(skill.operation) + "=" + printable(what));
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
  if (!names_a_node(options))
    print_requirements(skill.descriptor);
  else if (!check_grants(options, skill.descriptor))
    return exit_refused;
  print("nothing is wrong with skill '" + printable(skill.descriptor.operation)
        + "', build " + skill.hash.substr(0, short_hash) + ", for "
        + options.architecture + "\n");
  return exit_done;
}

} // namespace

void add_skill_check_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<check_options>();
  auto* command = skills.add_subcommand("check", "Validate a skill folder.");
  command->footer(
      "Checks the descriptor, and whether its program is there, can be run, "
      "is for the machine,\nand finds its shared libraries. Nothing is "
      "started. A node refuses such a skill when it\nstarts, and `roscell "
      "skills` shows why. With --to or $ROSCELL_TO that node is asked what it "
      "grants.\n\n"
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
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return check_skill(*options); };
  });
}

} // namespace roscell::cli
