#pragma once

#include "actors/edge/history/event_files.hpp"
#include "actors/edge/history/event_lines.hpp"
#include "actors/edge/history/kept_log_folder.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// How much of the past is kept.
struct history_bound {
  uint64_t bytes = 0;
  std::chrono::milliseconds age{0};
};

/// All that a node keeps of the past, in one folder: events, and logs of
/// instances that are gone. Both share one bound; the oldest goes first. May be
/// used by several threads: whoever writes what matters more takes its room.
class history_folder {
public:
  /// Makes the folder where there is none. One that cannot be made or read
  /// holds nothing, and what is to be written is refused.
  history_folder(const std::filesystem::path& folder, history_bound bound);

  /// The number that the events of this run begin above.
  uint64_t first_number() const {
    return first_number_;
  }

  /// Writes a batch and holds the bound; without room, older things go for it.
  /// Returns what is set aside of the numbers.
  edge_result<events_written> write(const event_batch& batch);

  std::vector<event> read(const past_events_query& query) const;

  /// Removes what is too much or too old.
  void hold_bound();

  /// Gives way to what matters more: removes the older half. False: there was
  /// nothing.
  bool make_room();

  /// Calls `look` with the logs that are kept.
  template <class F>
  auto with_logs(F&& look) const {
    std::lock_guard<std::mutex> lock{mutex_};
    return look(logs_);
  }

private:
  uint64_t bytes() const;
  bool drop_oldest();
  void drop_down_to(uint64_t bytes);
  void drop_old(int64_t now_unix_ms);

  mutable std::mutex mutex_;
  history_bound bound_;
  event_files events_;
  event_numbers numbers_;
  kept_log_folder logs_;
  uint64_t first_number_ = 0;
  uint64_t last_number_ = 0; ///< That has been written.
};

} // namespace roscell
