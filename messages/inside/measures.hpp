#pragma once

#include "messages/cell.hpp"

#include <string>
#include <vector>

namespace roscell {

/// Asks what the skills of a whole cell say of themselves.
struct collect_metrics {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// What they say is known now, as far as their nodes have answered in time.
struct metrics_collected {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Asks for all that can be counted of a cell, as it is known.
struct measure_cell {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// A node of the cell.
struct node_measures {
  row_state state = row_state::expected;
  node_resources resources;

  static constexpr auto fields() {
    return field_list{required("state", &node_measures::state),
                      required("resources", &node_measures::resources)};
  }
};

/// An instance, without what only people read.
struct instance_measures {
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  instance_state state = instance_state::pending;
  int64_t restarts = 0;
  instance_metrics metrics;
  instance_health health = instance_health::good;

  static constexpr auto fields() {
    return field_list{required("instance", &instance_measures::instance),
                      required("task", &instance_measures::task),
                      required("step", &instance_measures::step),
                      required("node", &instance_measures::node),
                      required("state", &instance_measures::state),
                      required("restarts", &instance_measures::restarts),
                      required("figures", &instance_measures::metrics),
                      required("health", &instance_measures::health)};
  }
};

inline instance_measures measures_of(const instance_row& row) {
  return {row.spec.instance, row.spec.task, row.spec.step, row.node,
          row.state,         row.restarts,  row.metrics,   row.health};
}

/// Tasks that are in one state.
struct task_count {
  task_state state = task_state::deploying;
  int64_t tasks = 0;

  static constexpr auto fields() {
    return field_list{required("state", &task_count::state),
                      required("tasks", &task_count::tasks)};
  }
};

/// Reply to `measure_cell`.
struct cell_measured {
  std::vector<node_measures> nodes;
  std::vector<instance_measures> instances;
  std::vector<task_count> tasks; ///< Of every state.

  static constexpr auto fields() {
    return field_list{required("nodes", &cell_measured::nodes),
                      required("instances", &cell_measured::instances),
                      required("tasks", &cell_measured::tasks)};
  }
};

} // namespace roscell
