#pragma once

#include "messages/task.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// How a task is changed while it runs, and the requests that it has had.
namespace roscell {

/// What a step does in an update.
enum class step_action {
  stays,    ///< Its process is not touched.
  starts,   ///< The task did not have it.
  stops,    ///< The task has it no more.
  restarts, ///< Its process is replaced on its node.
  moves,    ///< The same, on another node.
};

constexpr auto enum_words(step_action) {
  return std::array<std::string_view, 5>{"stays", "starts", "stops", "restarts",
                                         "moves"};
}

struct step_change {
  std::string step;
  step_action action = step_action::stays;
  std::string instance; ///< The present one; empty: there is none.
  std::string from;     ///< Its node.
  std::string to;       ///< Node of the new one; empty: there is none.
  /// What differs, a sentence each: "parameters.rate_hz: 5 -> 10".
  std::vector<std::string> reasons;

  static constexpr auto fields() {
    return field_list{required("step", &step_change::step),
                      required("action", &step_change::action),
                      optional("instance", &step_change::instance),
                      optional("from", &step_change::from),
                      optional("to", &step_change::to),
                      optional("reasons", &step_change::reasons)};
  }
};

/// Changes a task that runs into this one, step by step, or not at all: what
/// has not changed goes on. Answered once it is known what that means, and
/// written down. How it goes on is in `task_row`.
struct task_update {
  static constexpr const char* type = "task_update";
  std::string task;
  std::vector<task_step> pipeline;
  double timeout_s = 0;                      ///< As in `task_request`.
  std::map<std::string, std::string> labels; ///< The same.
  update_policy update;                      ///< The same.
  bool dry_run = false;     ///< It is only shown what would be done.
  bool keep_builds = false; ///< A newer build of its skill changes no step.
  bool restart_all = false; ///< Every step counts as changed.
  bool force = false;       ///< Nothing is waited for to be stop-safe.
  std::string set;          ///< As in `task_request`.

  static constexpr auto fields() {
    return field_list{required("task", &task_update::task),
                      required("pipeline", &task_update::pipeline),
                      optional("timeout_s", &task_update::timeout_s),
                      optional("labels", &task_update::labels),
                      optional("update", &task_update::update),
                      optional("dry_run", &task_update::dry_run),
                      optional("keep_builds", &task_update::keep_builds),
                      optional("restart_all", &task_update::restart_all),
                      optional("force", &task_update::force),
                      optional("set", &task_update::set)};
  }
};

enum class update_outcome {
  unchanged, ///< The task is as the request says.
  ended,     ///< The same, and all of it has ended; it stays so.
  next_run,  ///< It has ended, and a `task_request` that replaces it runs it.
  shown,     ///< It differs, and nothing was done about it.
  begun,     ///< It differs, and is being changed.
};

constexpr auto enum_words(update_outcome) {
  return std::array<std::string_view, 5>{"unchanged", "ended", "next_run",
                                         "shown", "begun"};
}

/// Reply to `task_update`.
struct task_update_plan {
  static constexpr const char* type = "task_update_plan";
  std::string task;
  update_outcome outcome = update_outcome::unchanged;
  int64_t revision = 1; ///< That it has, or will have once all is changed.
  std::vector<step_change> changes;  ///< One a step, old or new.
  std::vector<std::string> reasons;  ///< What differs of the task as a whole.
  std::vector<std::string> warnings; ///< As in `task_plan`.

  static constexpr auto fields() {
    return field_list{required("task", &task_update_plan::task),
                      required("outcome", &task_update_plan::outcome),
                      required("revision", &task_update_plan::revision),
                      required("changes", &task_update_plan::changes),
                      optional("reasons", &task_update_plan::reasons),
                      optional("warnings", &task_update_plan::warnings)};
  }
};

/// Asks for the requests that a task has had.
struct task_revisions_query {
  static constexpr const char* type = "task_revisions_query";
  std::string task;

  static constexpr auto fields() {
    return field_list{required("task", &task_revisions_query::task)};
  }
};

/// A request that a task has had.
struct task_revision {
  int64_t revision = 1;
  int64_t since_unix_ms = 0; ///< When the task became so.
  std::string request;       ///< JSON of the `task_request`.
  /// Hash of the build that each step had; those that are not known are absent.
  std::map<std::string, std::string> builds;

  static constexpr auto fields() {
    return field_list{required("revision", &task_revision::revision),
                      required("since_unix_ms", &task_revision::since_unix_ms),
                      raw_json("request", &task_revision::request),
                      optional("builds", &task_revision::builds)};
  }
};

struct task_revisions {
  static constexpr const char* type = "task_revisions";
  std::string task;
  std::vector<task_revision> revisions; ///< The present one last.

  static constexpr auto fields() {
    return field_list{required("task", &task_revisions::task),
                      required("revisions", &task_revisions::revisions)};
  }
};

} // namespace roscell
