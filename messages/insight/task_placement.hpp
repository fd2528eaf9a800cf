#pragma once

#include "messages/codec/described.hpp"

#include <cstdint>
#include <string>

namespace roscell {

/// Asks why a task is where it is, or why it was refused. Kept are the last
/// 100 decisions, since the coordinator's start.
struct task_placement_query {
  static constexpr const char* type = "task_placement_query";
  std::string task;

  static constexpr auto fields() {
    return field_list{required("task", &task_placement_query::task)};
  }
};

/// Reply to `task_placement_query`: what was decided when the task was asked
/// for the last time.
struct task_placement {
  static constexpr const char* type = "task_placement";
  std::string task;
  int64_t decided_unix_ms = 0;
  std::string plan;    ///< JSON of a `task_plan`; empty: it was refused.
  std::string refusal; ///< JSON of the `error` then, else empty.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_placement::task),
        required("decided_unix_ms", &task_placement::decided_unix_ms),
        raw_json("plan", &task_placement::plan),
        raw_json("refusal", &task_placement::refusal)};
  }
};

} // namespace roscell
