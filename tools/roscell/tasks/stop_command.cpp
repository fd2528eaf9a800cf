#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/task_options.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

struct stop_options : task_options {
  std::vector<std::string> names; ///< Of tasks, or patterns of such names.
  bool yes = false;
};

bool is_pattern(const std::string& name) {
  return name.find_first_of("*?[") != std::string::npos;
}

void add_once(std::vector<std::string>& to, const std::string& name) {
  if (std::find(to.begin(), to.end(), name) == to.end())
    to.push_back(name);
}

/// A set ends with all its tasks, so it comes before them.
std::vector<std::string> known_names(const task_description& known) {
  std::vector<std::string> result;
  for (const auto& x : known.sets)
    result.push_back(x.task);
  for (const auto& x : known.tasks)
    result.push_back(x.task);
  return result;
}

/// The tasks that are meant, each once. A name that is no pattern need not be
/// that of a task: that is for the coordinator to say.
std::vector<std::string> tasks_meant(const node_client& node,
                                     const std::vector<std::string>& names) {
  task_description known;
  if (std::any_of(names.begin(), names.end(), is_pattern))
    known = node.get("/v1/tasks").get<task_description>();
  std::vector<std::string> result;
  for (const auto& name : names) {
    if (!is_pattern(name)) {
      add_once(result, name);
      continue;
    }
    bool matched = false;
    for (const auto& x : known_names(known))
      if (fnmatch(name.c_str(), x.c_str(), 0) == 0) {
        add_once(result, x);
        matched = true;
      }
    if (!matched)
      throw command_error{exit_refused,
                          "no task has a name like '" + printable(name) + "'",
                          "`roscell tasks` lists them"};
  }
  return result;
}

/// Whoever writes a pattern may mean others than he gets, so they are shown
/// before; who sits at a terminal is asked.
bool is_meant(const stop_options& options,
              const std::vector<std::string>& tasks) {
  if (!std::any_of(options.names.begin(), options.names.end(), is_pattern))
    return true;
  print_note("these tasks are ended: " + printable(joined(tasks, ", ")));
  if (options.yes || isatty(STDIN_FILENO) == 0)
    return true;
  print_text("end them? [y/N] ");
  std::string answer;
  std::getline(std::cin, answer);
  if (answer == "y" || answer == "yes")
    return true;
  print_note("none is ended");
  return false;
}

/// What is not stop-safe yet is waited for, unless a program has asked.
json stop_task(const stop_options& options, const node_client& node,
               const std::string& task) {
  const auto ask = [&] {
    return ask_or_throw(options, task,
                        message_json(task_termination{task, options.force}));
  };
  const auto kept = kept_events_of(node);
  auto reply = ask();
  const auto reported = reply.get<task_terminated>();
  if (reported.waiting.empty() || options.as_json())
    return reply;
  for (const auto& x : reported.waiting)
    print_note(waiting_text(x));
  wait_until_gone(node, task, kept.empty() ? 0 : kept.back().sequence);
  return ask();
}

/// Those that are refused are told, and the others are ended all the same.
/// @return the exit code of the first refusal.
int stop_each(const stop_options& options, const node_client& node,
              const std::vector<std::string>& tasks) {
  int result = exit_done;
  auto replies = json::array();
  for (const auto& task : tasks) {
    try {
      replies.push_back(stop_task(options, node, task));
    } catch (const refused& why) {
      replies.push_back(why.reply);
      if (!options.as_json())
        print_refusal(why.reply);
      if (result == exit_done)
        result = exit_code_of_refusal(why.reply);
      continue;
    }
    if (!options.as_json())
      print(terminated_view(replies.back().get<task_terminated>()));
  }
  if (options.as_json())
    print(pretty(replies));
  return result;
}

int stop(const stop_options& options) {
  const node_client node{options.connection};
  const auto tasks = tasks_meant(node, options.names);
  if (!is_meant(options, tasks))
    return exit_refused;
  if (options.names.size() > 1 || is_pattern(options.names.front()))
    return stop_each(options, node, tasks);
  const auto reply = stop_task(options, node, tasks.front());
  print(options.as_json() ? pretty(reply)
                          : terminated_view(reply.get<task_terminated>()));
  return exit_done;
}

} // namespace

void add_stop_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<stop_options>();
  auto* command = add_task_command(
      app, "stop", "End tasks and remove their instances everywhere.",
      "A pattern, such as 'py-*', means all tasks of the cell with such a "
      "name: "
      "they are shown\nfirst, and at a terminal you are asked. What has to be "
      "stop-safe before it ends is waited\nfor. Ctrl-C ends the waiting "
      "only.\n\n"
      "Examples:\n  roscell stop fleet-poses\n"
      "  roscell stop fleet-poses fleet-video\n  roscell stop 'fleet-*' --yes\n"
      "  roscell stop fleet-poses --force",
      *options);
  add_force_option(*command, *options);
  command->add_flag("--yes", options->yes,
                    "Do not ask before tasks that a "
                    "pattern means are ended");
  command->add_option("TASK", options->names, "Their names, or patterns")
      ->required()
      ->option_text("...");
  command->callback(
      [&chosen, options] { chosen = [options] { return stop(*options); }; });
}

} // namespace roscell::cli
