#pragma once

#include "roscell/node_event.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

/// What a program that embeds a node hears of it, and asks it, without actors.
namespace roscell {

enum class log_level { debug, info, warning };

/// Why a node is in no cell.
struct join_problem {
  std::string where;  ///< Discovery server that was tried; empty: any cell.
  std::string reason; ///< One sentence; empty: the node is in a cell now.
  std::string hint;   ///< What to do about it; may be empty.
};

/// Each may be empty. They are called on one thread of the node's own, one
/// after the other, from the start of the node until it has ended. They may
/// take their time and ask the node, but not end it; what they throw is
/// dropped.
struct node_callbacks {
  /// Each event of the node, as `roscell events` shows it.
  std::function<void(const node_event&)> on_event;
  /// The same as a line for a log.
  std::function<void(log_level, const std::string&)> on_log;
  /// Each time that something else keeps the node from its cell, such as a
  /// site token that is missing, and when nothing does any more.
  std::function<void(const join_problem&)> on_join_problem;
};

/// A step of a task.
struct step_status {
  std::string step;
  std::string instance;
  std::string node;
  std::string state;  ///< As `roscell instances` shows it, "running".
  std::string reason; ///< Why it failed or stopped; may be empty.
};

inline bool operator==(const step_status& x, const step_status& y) {
  return x.step == y.step && x.instance == y.instance && x.node == y.node
         && x.state == y.state && x.reason == y.reason;
}

struct task_status {
  std::string task;
  /// "deploying", "running", "degraded", "terminating", "finished", "failed";
  /// "gone": the cell has no such task any more.
  std::string state;
  std::vector<step_status> steps;
};

inline bool operator==(const task_status& x, const task_status& y) {
  return x.task == y.task && x.state == y.state && x.steps == y.steps;
}

/// Watches a task as long as it lives. Its end waits for a call that is being
/// made, unless it is ended by that call itself; no other call follows.
class task_watch {
public:
  class impl;

  explicit task_watch(std::shared_ptr<impl> parts);
  ~task_watch();
  task_watch(task_watch&&) noexcept;
  task_watch& operator=(task_watch&&) noexcept;

private:
  std::shared_ptr<impl> impl_;
};

} // namespace roscell
