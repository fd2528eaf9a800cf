#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/known_skills.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

struct skill_options {
  skill_source source;
  std::string output = "table";
  std::string operation;
};

struct skeleton_options {
  skill_source source;
  std::string name = "my_task";
  std::vector<std::string> operations;
};

int show_skill(const skill_options& options) {
  const auto rows = rows_of(find_skills(options.source), options.operation);
  if (options.output != "json") {
    print(skill_view(rows, stdout_style()));
    return exit_done;
  }
  auto list = json::array();
  for (const auto& row : rows)
    list.push_back(row);
  print(pretty(shaped(list)));
  return exit_done;
}

int print_skeleton(const skeleton_options& options) {
  print(task_skeleton(options.name, options.operations,
                      find_skills(options.source)));
  return exit_done;
}

} // namespace

void add_skill_show_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<skill_options>();
  auto* command = skills.add_subcommand(
      "show", "Show how a skill is used: its models and their parameters.");
  command->footer("Examples:\n  roscell skills show pose_estimation\n"
                  "  roscell skills show echo --skills build/release/skills");
  command->add_option("OPERATION", options->operation, "What the skill does")
      ->required()
      ->option_text(" ");
  add_skill_source(*command, options->source);
  add_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_skill(*options); };
  });
}

void add_new_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<skeleton_options>();
  auto* what = app.add_subcommand("new", "Generate a template.");
  what->require_subcommand(1);
  auto* command = what->add_subcommand(
      "task", "Print a task request that does these operations one after the "
              "other,\nwith comments on what to fill in.");
  command->footer(
      "Each step reads what the one before it writes, where it can.\n\n"
      "Examples:\n  roscell new task image_source pose_estimation > task.yaml\n"
      "  roscell new task echo --skills build/release/skills");
  command
      ->add_option("OPERATION", options->operations,
                   "What the steps do; `roscell skills` lists what there is")
      ->required()
      ->option_text("...");
  command->add_option("--name", options->name, "Name of the task")
      ->option_text("NAME [my_task]");
  add_skill_source(*command, options->source);
  command->callback([&chosen, options] {
    chosen = [options] { return print_skeleton(*options); };
  });
  add_new_config_command(app, *what, chosen);
}

} // namespace roscell::cli
