#pragma once

#include "client/known_cell.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roscell {

/// How it stands with the node that is asked.
struct connection_state {
  bool live = false;
  int64_t since_unix_ms = 0; ///< When that began.
  std::string problem;       ///< What is wrong; empty: nothing, or not known.
};

/// What has to be asked again.
struct questions {
  bool cell = false;    ///< Nodes, tasks and their instances.
  bool metrics = false; ///< Rates, latencies and the like.
  bool skills = false;

  bool any() const {
    return cell || metrics || skills;
  }

  void add(const questions& other) {
    cell = cell || other.cell;
    metrics = metrics || other.metrics;
    skills = skills || other.skills;
  }
};

/// All that is known of a cell, as it is told: answers replace what was known,
/// events change it at once where they say enough, and name what has to be
/// asked again.
class cell_model {
public:
  /// So many events are kept, the newest.
  static constexpr size_t most_events = 1000;

  /// The node answers, and has kept these events since it answered before.
  void open(std::vector<event> kept, int64_t now_unix_ms);

  /// The node is away. What was known stays.
  void lose(const std::string& why, int64_t now_unix_ms);

  /// A question was not answered, although the events come.
  void miss(const std::string& why);

  void set_cell(node_description asked, cell_description cell);
  void set_metrics(const std::vector<instance_row>& rows);
  void set_skills(skill_list skills);

  /// Returns what has to be asked again because of it.
  questions add(event e);

  const known_cell& known() const {
    return known_;
  }

  const connection_state& connection() const {
    return connection_;
  }

  /// Whether any answer has come yet.
  bool begun() const {
    return begun_;
  }

private:
  void change_instance(const event& e);
  void lose_node(const event& e);

  /// Calls `change` for each copy of a known instance.
  template <class Change>
  void for_each_row(const Change& change);

  known_cell known_;
  connection_state connection_;
  bool begun_ = false;
  std::map<std::string, instance_row> reported_; ///< With metrics, by id.
};

/// Which answers of a node an event makes old: its name, or with "*" at the end
/// what that begins with, and the answers: "cell", "cells", "skills", "node",
/// "task" (the one that the event is of). Where several fit the first counts;
/// who follows a cell, here or in a browser, asks for these again.
using stale_list =
    std::vector<std::pair<std::string, std::vector<std::string>>>;

const stale_list& stale_answers();

/// Those that an event of that name makes old; empty for one that says all that
/// there is to know.
const std::vector<std::string>& stale_after(std::string_view what);

} // namespace roscell
