#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <string>

/// The ends of steps, by themselves and by order of the CELL COORDINATOR. Ends
/// are written to the task's record, and with the last one what has become of
/// the task. An order (`ordered_stop`) is on the disk before the node hears of
/// it, so that the end means the same after a restart; it stands in
/// `st.orders` until it is fulfilled or taken back.
namespace roscell {

/// Takes what the nodes have told of a task's ends into its record.
void record_ends(coordinator_pointer self, const std::string& task);

/// Writes down that an instance whose end is ignored so far was ended for that
/// reason, whatever its exit code, and heeds its ends again.
/// @param done called once: when that is written, or the task is gone.
void record_forced_end(coordinator_pointer self, const std::string& task,
                       const std::string& instance, const std::string& reason,
                       const completion_handler& done);

/// Tells what has become of a task whose steps have all ended, and forgets the
/// oldest of these. Nothing happens while a step of it runs.
void settle_ended(coordinator_pointer self, const std::string& task);

// Ends by order: of instances that have not done their work, to start them
// again, elsewhere, or later.

enum class stop_outcome {
  ended,     ///< It surely runs no more.
  had_ended, ///< It has ended by itself before, or is not wanted to end now.
  failed,    ///< It is not known, or it was not told to end.
};

struct ordered_stop {
  std::string task;
  std::string node;
  end_order order;
  bool force = false;
  /// When it is waited for no longer.
  std::chrono::steady_clock::time_point until =
      std::chrono::steady_clock::time_point::max();
  /// Whoever has it ended starts another one in its place: until then its end
  /// is none of its task.
  bool has_successor = false;
  /// Asked once the order is on disk; may be null.
  std::function<bool()> still = nullptr;
  /// Called before the node is asked; may be null.
  std::function<void()> asked = nullptr;
  /// Called once: when it is known what has become of it, or the time is over.
  /// Only `failed` has an error.
  std::function<void(stop_outcome, const completion&)> done;
};

/// Ends an instance by order, and waits until it is stop-safe, or the time is
/// over.
///
/// While the order is written it may end by itself, which is its own end then.
/// While it is waited for its node may be lost, its task be terminated, or the
/// time be over: then the order stands, and what ends by it later is started
/// anew.
void stop_by_order(coordinator_pointer self, const ordered_stop& stop);

/// What had a successor does not get one. If it has ended it has failed, for
/// this reason; if not, it is started anew once it has, or runs on where its
/// node was away and nobody asks to end it any more.
void end_as_ordered(coordinator_pointer self, const std::string& task,
                    const std::string& instance, const std::string& reason);

/// The order is fulfilled, or taken back.
void drop_order(coordinator_pointer self, const std::string& task,
                const std::string& instance);

/// Why it is not told to end now: another request has done that, and one end
/// would not serve both.
std::optional<failure> why_not_ordered(const cell_coordinator_state& st,
                                       const std::string& instance);

/// Whether its node has told that it has ended.
bool has_ordered_end(const cell_coordinator_state& st, const deployment& x);

} // namespace roscell
