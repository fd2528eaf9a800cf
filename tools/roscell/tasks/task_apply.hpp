#pragma once

#include "messages/task_set.hpp"
#include "tools/roscell/tasks/preemption.hpp"
#include "tools/roscell/tasks/task_options.hpp"

#include <chrono>
#include <optional>
#include <string>

/// What `roscell apply`, `rollback` and `run --replace` do with one task: it is
/// started, or changed into what a request says.
namespace roscell::cli {

struct apply_options : task_options {
  bool dry_run = false;
  bool keep_builds = false;
  bool no_wait = false;
  preemption_options preemption; ///< For what is started as a whole.
};

/// Adds those that all of these commands have.
void add_apply_options(CLI::App& command, apply_options& options);

/// What is to be done with a task, or with a set of them.
struct task_plan_shown {
  json request;                     ///< The `task_request`.
  task_update_plan plan;            ///< Of a new task each step starts.
  bool is_new = false;              ///< The cell has no such task.
  std::optional<task_set_plan> set; ///< In place of the plan.

  /// Whether there is anything to be done.
  bool differs() const;
};

/// Asks what it means to apply a request; nothing is changed. Throws `refused`.
task_plan_shown plan_apply(const apply_options& options,
                           const node_client& node, const json& request);

/// Does it, and waits until all of it runs, unless that is not wanted. Throws
/// `refused`, or command_error for a change that was put back.
void make_apply(const apply_options& options, const node_client& node,
                const task_plan_shown& shown);

/// What is known of a task or set once it is another than `known`, or after a
/// while.
task_change next_change(const node_client& node, const std::string& task,
                        const std::string& known,
                        std::chrono::steady_clock::time_point until);

/// Ends all steps of a running task and starts them as a request says; throws
/// as above.
void replace_all(const apply_options& options, const node_client& node,
                 const json& request);

/// Somebody who types a command wants the task to run: once more, where it has
/// ended. Programs that may have to repeat themselves say an id of theirs.
void add_request_id(json& request);

} // namespace roscell::cli
