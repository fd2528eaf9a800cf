#pragma once

#include "messages/task_update.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// Where the update of a task is.
enum class update_stage {
  planned,  ///< It is being placed and written down.
  fetching, ///< Nodes get the builds of a wave that they lack.
  ending,   ///< The old instances of a wave end.
  starting, ///< The new ones start.
  settling, ///< They are to run well for a while.
  written,  ///< All have; the new request is being written down.
  undone,   ///< What was replaced is put back.
};

/// The tasks that are being changed while they run: one update a task, its
/// steps wave by wave. Pure; told the time.
///
///     [*] --> planned
///     planned -- it has places, and is written down --> fetching
///     planned -- it has none, or its task is no more --> [*]
///     fetching -- the nodes have the builds of the wave --> ending
///     ending -- the old ones of the wave have surely ended --> starting
///     starting -- the new ones run --> settling
///     settling -- they have run well for long enough, and there is a next
///                 wave --> fetching
///     settling -- the same, and it was the last --> written --> [*]
///     fetching to written -- anything goes wrong --> undone
///     undone -- all that was replaced runs again, or cannot --> [*]
///     any -- its task is terminated --> [*]
class update_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// The update of a task begins, with this request and that many waves; the
  /// task has none.
  uint64_t begin(const std::string& task, const std::string& request);

  /// What it does is known.
  void plan(uint64_t id, task_update_plan plan, size_t waves);

  bool is_updating(const std::string& task) const;

  /// Of the task's update; 0: there is none.
  uint64_t find_id(const std::string& task) const;

  /// Whether it has not ended.
  bool has(uint64_t id) const {
    return updates_.count(id) > 0;
  }

  /// The plan of the task's present update if that is for this request, and has
  /// one.
  const task_update_plan* find_plan(const std::string& task,
                                    const std::string& request) const;

  /// Whether it goes on, and is there.
  bool is_at(uint64_t id, update_stage stage) const;

  /// False if it has ended, or is being undone: then nothing goes on.
  bool enter(uint64_t id, update_stage stage);

  /// The next wave begins. Gives its number, from 0 on; none: there
  /// is no next one, and the update is to be written.
  std::optional<size_t> open_wave(uint64_t id);

  /// The new ones of the wave run, and are to do so until then.
  void settle(uint64_t id, const std::set<std::string>& instances,
              time_point until);

  /// The update that an instance is watched for: that has been started by it
  /// and is not settled yet; 0: none.
  uint64_t watching(const std::string& instance) const;

  /// Those whose wave has settled by now.
  std::vector<uint64_t> take_settled(time_point now);

  /// When the next wave has settled; max(): none is waited for.
  time_point next_due() const;

  void end(uint64_t id);

  /// How far the task's update is, one sentence; empty: there is none.
  std::string text(const std::string& task) const;

  size_t size() const {
    return updates_.size();
  }

private:
  struct entry {
    std::string task;
    std::string request;
    std::optional<task_update_plan> plan;
    update_stage stage = update_stage::planned;
    size_t waves = 0;
    size_t opened = 0; ///< Waves that have begun.
    std::set<std::string> started;
    time_point due = time_point::max();
  };

  const entry* find(const std::string& task) const;

  std::map<uint64_t, entry> updates_;
  uint64_t last_ = 0;
};

} // namespace roscell
