#include "schemas/message_catalogue.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/pruning.hpp"
#include "tools/roscell/tasks/task_apply.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/update_view.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace roscell::cli {

namespace {

struct apply_command_options : apply_options {
  std::vector<std::string> files;
  file_values values;
  std::string prune; ///< "NAME=VALUE": a label.
};

/// A document of the command line, and what it means.
struct applied_task {
  task_file file;
  task_plan_shown shown;
};

std::vector<task_file> read_all(const apply_command_options& options) {
  std::vector<task_file> result;
  for (const auto& name : options.files)
    for (auto& file : read_task_files(name, options.values))
      result.push_back(std::move(file));
  if (result.empty())
    throw command_error{exit_usage,
                        "there is no task in "
                            + printable(joined(options.files, ", ")),
                        "`roscell new task echo` writes one"};
  return result;
}

/// All of them are looked at before anything is asked.
void check_all(const std::vector<task_file>& files) {
  std::map<std::string, const task_file*> names;
  for (const auto& file : files) {
    if (auto why = validate_request(file.request()))
      throw wrong_document{file, *why};
    const auto task = file.request().value("task", "");
    if (const auto [known, is_new] = names.emplace(task, &file); !is_new)
      throw wrong_document{
          file,
          {error_code::schema_violation,
           "task '" + task + "' is in " + known->second->name + " already",
           "/task"}};
  }
}

/// Does something with one document, whose places a refusal points to.
template <class Function>
void with_document(const task_file& file, Function&& act) {
  try {
    act();
  } catch (const refused& why) {
    throw wrong_document{file, failure_from(why.reply)};
  }
}

std::string plural(size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// What has become of a task, in a line.
std::string done_text(const task_plan_shown& x) {
  if (x.set)
    return "set '" + printable(x.set->task) + "' "
           + (x.differs() ? "is as the file says" : "is as it is to be");
  const auto task = "task '" + printable(x.plan.task) + "' ";
  if (x.is_new)
    return task + "runs";
  switch (x.plan.outcome) {
  case update_outcome::unchanged:
    return task + "is as it is to be";
  case update_outcome::ended:
    return task
           + "has ended, and is as it was to be; `roscell run` starts it "
             "once more";
  case update_outcome::next_run:
    return task + "runs once more";
  default:
    break;
  }
  const auto stay = std::count_if(
      x.plan.changes.begin(), x.plan.changes.end(),
      [](const auto& step) { return step.action == step_action::stays; });
  const auto all = x.plan.changes.size();
  return task + "is changed, revision " + std::to_string(x.plan.revision) + ": "
         + plural(all - static_cast<size_t>(stay), "step") + " of "
         + std::to_string(all);
}

/// What differs, for people; nothing for what does not.
std::string differences_view(const std::vector<task_update_plan>& plans) {
  std::vector<task_update_plan> differing;
  for (const auto& x : plans)
    if (x.outcome != update_outcome::unchanged
        && x.outcome != update_outcome::ended)
      differing.push_back(x);
  return changes_view(differing, stdout_style());
}

struct apply_work {
  std::vector<applied_task> tasks;
  std::vector<task_row> pruned;

  std::vector<task_set_plan> sets() const {
    std::vector<task_set_plan> result;
    for (const auto& x : tasks)
      if (x.shown.set && x.shown.differs())
        result.push_back(*x.shown.set);
    return result;
  }

  std::vector<task_update_plan> plans() const {
    std::vector<task_update_plan> result;
    for (const auto& x : tasks)
      if (!x.shown.set)
        result.push_back(x.shown.plan);
    for (const auto& x : pruned)
      result.push_back(plan_of_pruned(x));
    return result;
  }

  bool differs() const {
    return !pruned.empty()
           || std::any_of(tasks.begin(), tasks.end(),
                          [](const auto& x) { return x.shown.differs(); });
  }
};

apply_work plan_all(const apply_command_options& options,
                    const node_client& node) {
  apply_work result;
  const auto files = read_all(options);
  check_all(files);
  result.pruned = to_be_pruned(options.prune, node, files);
  for (const auto& file : files)
    with_document(file, [&] {
      result.tasks.push_back({file, plan_apply(options, node, file.request())});
    });
  return result;
}

void print_plans(const apply_command_options& options, const apply_work& work) {
  const auto plans = work.plans();
  if (options.as_json()) {
    auto documents = json::array();
    for (const auto& x : plans)
      documents.push_back(message_json(x));
    for (const auto& x : work.tasks)
      if (x.shown.set)
        documents.push_back(message_json(*x.shown.set));
    return print(pretty(documents));
  }
  for (const auto& x : plans)
    for (const auto& warning : x.warnings)
      print_note("warning: " + printable(warning));
  if (work.differs())
    print(differences_view(plans)
          + set_changes_view(work.sets(), stdout_style()));
}

/// In the order of the files; what is not wanted any more goes last. The first
/// that fails ends it.
void make_all(const apply_command_options& options, const node_client& node,
              const apply_work& work) {
  for (const auto& x : work.tasks) {
    if (x.shown.differs())
      with_document(x.file, [&] { make_apply(options, node, x.shown); });
    print_note(done_text(x.shown));
  }
  for (const auto& x : work.pruned) {
    const auto reply = ask_or_throw(
        options, x.task, message_json(task_termination{x.task, options.force}));
    print_text(terminated_view(reply.get<task_terminated>()));
  }
}

int apply_files(const apply_command_options& options) {
  const node_client node{options.connection};
  const auto work = plan_all(options, node);
  print_plans(options, work);
  if (!options.dry_run) {
    make_all(options, node, work);
    return exit_done;
  }
  if (!work.differs() && !options.as_json())
    print_note("nothing differs");
  return work.differs() ? exit_refused : exit_done;
}

/// As `diff` has it: 1 says that something differs, so trouble is 2.
int as_diff(const apply_command_options& options, int code) {
  return options.dry_run && code == exit_refused ? exit_usage : code;
}

int apply_or_show(const apply_command_options& options) {
  try {
    return apply_files(options);
  } catch (const wrong_document& why) {
    return as_diff(options, show_wrong_document(why, options.as_json()));
  } catch (const refused& why) {
    if (!options.dry_run)
      throw;
    print_refusal(why.reply);
    return as_diff(options, exit_code_of_refusal(why.reply));
  }
}

} // namespace

void add_apply_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<apply_command_options>();
  auto* command = add_task_command(
      app, "apply", "Make tasks what files say.",
      "What the cell does not have is started; a task that runs is changed: "
      "steps that do not\ndiffer go on, the others are replaced one after the "
      "other, each well before the next, and\nall of it is put back where one "
      "does not run well. A file may hold several tasks, parted\nby --- lines "
      "in YAML or as a list in JSON. A task that has ended and does not differ "
      "stays so.\n\n"
      "Examples:\n  roscell apply cell/*.yaml\n"
      "  roscell apply --dry-run task.yaml\n"
      "  roscell apply --prune line=3 line3.yaml\n"
      "  roscell new task echo | roscell apply -",
      *options);
  command
      ->add_option("FILE", options->files,
                   "Task requests; - for standard input")
      ->required()
      ->option_text("...");
  add_apply_options(*command, *options);
  command
      ->add_option("--prune", options->prune,
                   "End the tasks that have this label and are in no FILE")
      ->option_text("LABEL=VALUE");
  add_value_options(*command, options->values);
  add_preemption_options(*command, options->preemption);
  command->callback([&chosen, options] {
    options->force = options->preemption.force;
    chosen = [options] { return apply_or_show(*options); };
  });
}

} // namespace roscell::cli
