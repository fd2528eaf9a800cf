#include "tools/roscell/cells/cell_export.hpp"
#include "tools/roscell/cells/cell_plan.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct export_options {
  connection_options connection;
  std::string file;
  bool no_skills = false;
};

using options_ptr = std::shared_ptr<cell_options>;

void show_plan(const cell_options& options, const cell_plan& plan) {
  if (options.as_json())
    print(pretty(cell_plan_json(plan)));
  else if (plan.differs())
    print(cell_plan_view(plan, stdout_style()));
  else
    print_note("nothing differs");
}

int diff_cell(const cell_options& options) {
  const node_client node{options.connection};
  const auto wanted = read_cell_document(options.file, options.values);
  const auto plan = plan_cell(options, node, wanted);
  show_plan(options, plan);
  return plan.differs() ? exit_refused : exit_done;
}

int apply_cell(const cell_options& options) {
  const node_client node{options.connection};
  const auto wanted = read_cell_document(options.file, options.values);
  const auto plan = plan_cell(options, node, wanted);
  show_plan(options, plan);
  make_cell(options, node, plan);
  return exit_done;
}

/// As `diff` has it: 1 says that something differs, so trouble is 2.
int show_difference(const cell_options& options) {
  const auto as_diff = [](int code) {
    return code == exit_refused ? static_cast<int>(exit_usage) : code;
  };
  try {
    return diff_cell(options);
  } catch (const wrong_document& why) {
    return as_diff(show_wrong_document(why, options.as_json()));
  } catch (const refused& why) {
    print_refusal(why.reply);
    return as_diff(exit_code_of_refusal(why.reply));
  }
}

CLI::App* add_document_command(CLI::App& cell, const char* name,
                               const char* description, const char* footer,
                               const options_ptr& options) {
  auto* command = add_task_command(cell, name, description, footer, *options);
  command
      ->add_option("FILE", options->file,
                   "The document of the cell; - for standard input")
      ->required()
      ->option_text(" ");
  command->add_flag("--prune", options->prune,
                    "What the cell has besides goes: tasks are ended, skills "
                    "removed, nodes released");
  command->add_flag("--take-nodes", options->take_nodes,
                    "Bring nodes in that are in other cells, too");
  command->add_flag("--keep-builds", options->keep_builds,
                    "A newer build of its skill changes no step");
  add_value_options(*command, options->values);
  return command;
}

void add_apply(CLI::App& cell, action& chosen) {
  auto options = std::make_shared<cell_options>();
  auto* command = add_document_command(
      cell, "apply", "Make the cell what a document says.",
      "Nodes come in, skills are added, tasks are started or changed as by "
      "`roscell apply`; what\nthe cell has besides stays, unless --prune. It "
      "is shown first.\n\n"
      "Examples:\n  roscell cell apply line.json\n"
      "  roscell cell apply --prune --to 192.168.1.10 line.json",
      options);
  add_force_option(*command, *options);
  command->callback([&chosen, options] {
    chosen = [options] {
      return with_marks(options->as_json(),
                        [&] { return apply_cell(*options); });
    };
  });
}

void add_diff(CLI::App& cell, action& chosen) {
  auto options = std::make_shared<cell_options>();
  auto* command = add_document_command(
      cell, "diff", "Show what of a cell is not as a document says.",
      "Exit code 0: nothing differs, 1: something does, 2: it cannot be "
      "said.\n\n"
      "Examples:\n  roscell cell diff line.json\n"
      "  roscell cell diff --prune line.json -o json",
      options);
  command->callback([&chosen, options] {
    chosen = [options] { return show_difference(*options); };
  });
}

void add_export(CLI::App& cell, action& chosen) {
  auto options = std::make_shared<export_options>();
  auto* command = cell.add_subcommand(
      "export", "Write down what a cell has, to make it anew elsewhere.");
  command->footer(
      "Its members, the skills that were added to it, and the tasks that have "
      "not ended. The builds\nof these skills are put beside FILE, into "
      "NAME.skills. `roscell cell apply` makes it anew.\n\n"
      "Examples:\n  roscell cell export line.json\n"
      "  roscell cell export - | jq .tasks");
  command
      ->add_option("FILE", options->file,
                   "The document that is written; - for standard output, "
                   "without builds")
      ->required()
      ->option_text(" ");
  command->add_flag("--no-skills", options->no_skills,
                    "Do not copy the builds of skills");
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] {
      export_cell(node_client{options->connection}, options->file,
                  !options->no_skills);
      return exit_done;
    };
  });
}

} // namespace

void add_cell_command(CLI::App& app, action& chosen) {
  auto* cell = app.add_subcommand(
      "cell", "Write down a cell as a document, and make it what one says.");
  cell->require_subcommand(1);
  add_apply(*cell, chosen);
  add_diff(*cell, chosen);
  add_export(*cell, chosen);
}

} // namespace roscell::cli
