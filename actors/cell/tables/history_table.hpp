#pragma once

#include "messages/event.hpp"
#include "messages/task.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// One event of a task's history, as it is stored.
struct history_record {
  std::string task;
  event recorded;

  static constexpr auto fields() {
    return field_list{required("task", &history_record::task),
                      required("fact", &history_record::recorded)};
  }
};

/// Key of an event in the store: those of one task sort by their numbers.
std::string history_key(const std::string& task, uint64_t sequence);

/// What has happened to tasks, also to those that are gone. Pure and bounded:
/// of each task it keeps the first events and the newest ones, of tasks those
/// that something has happened to last.
class history_table {
public:
  /// An event that was added, and the keys of those that had to go for it.
  struct addition {
    history_record record;
    std::vector<std::string> dropped;
  };

  addition add(const std::string& task, event recorded);

  /// What an earlier run of the coordinator has stored, in any order.
  void restore(std::vector<history_record> records);

  /// None: nothing is known of such a task.
  std::optional<task_history> find(const std::string& task) const;

private:
  struct story {
    uint64_t last_sequence = 0;
    int64_t dropped = 0;
    std::vector<event> first;
    std::deque<event> newest;
  };

  void drop_oldest_task(const std::string& but, addition& result);

  std::map<std::string, story> stories_;
};

} // namespace roscell
