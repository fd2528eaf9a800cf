#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR has nodes remove instances. What is not stop-safe
/// yet is waited for, however long that takes.
namespace roscell {

/// What is removed of a task, and who hears of it.
struct task_removal {
  std::string task;
  std::vector<std::string> also_on; ///< Room may be kept for it there.
  bool force = false;
  /// All nodes have answered, and these instances are not stop-safe yet; may be
  /// null. Not called if there are none.
  std::function<void(const std::vector<safety_wait>& waiting)> waits;
  /// All are gone, but on nodes that are away.
  std::function<void(const std::vector<std::string>& away)> done;
};

/// Has all nodes remove what they have of a task.
void remove_everywhere(coordinator_pointer self, const task_removal& request);

/// Has a node remove one instance, then goes on. One that is overdue is asked
/// for again, whatever comes next; one that is not stop-safe yet is waited for,
/// until then. So what comes next asks whether it is gone.
void remove_instance(coordinator_pointer self, const overdue_removal& what,
                     const std::function<void()>& done, bool force = false,
                     std::chrono::steady_clock::time_point until =
                         std::chrono::steady_clock::time_point::max());

/// Whether a node cannot be asked for anything: it is lost, or gone.
bool is_away(const cell_coordinator_state& st, const std::string& node);

/// Does not wait any longer for what of a task is not stop-safe.
void force_removals(coordinator_pointer self, const std::string& task);

/// The same for what is on a node.
void force_removals_on(coordinator_pointer self, const std::string& node);

/// What of a task is waited for to be stop-safe.
std::vector<safety_wait> safety_waits_of(const cell_coordinator_state& st,
                                         const std::string& task);

/// An instance has ended: whoever has waited for it to be stop-safe goes on.
void on_instance_gone(coordinator_pointer self, const std::string& node,
                      const std::string& instance);

/// A node is away, so nothing of it is waited for: it is told what to stop when
/// it comes back.
void give_up_waits_on(coordinator_pointer self, const std::string& node);

/// Goes on where what is not stop-safe was waited for long enough.
void give_up_late_waits(coordinator_pointer self);

/// Asks once more for what is overdue.
void ask_overdue_removals(coordinator_pointer self);

} // namespace roscell
