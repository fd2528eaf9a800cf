#pragma once

#include "messages/task_set.hpp"
#include "tools/roscell/view/table.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What changes of tasks mean, for people.
namespace roscell::cli {

/// A step of a task, and what it does; without those that stay, unless `wide`.
std::string changes_view(const std::vector<task_update_plan>& tasks,
                         const text_style& style);

/// What the tasks of sets do, node by node, without those that stay.
std::string set_changes_view(const std::vector<task_set_plan>& sets,
                             const text_style& style);

/// The requests that a task has had, with what each changed.
std::string revisions_view(const task_revisions& task, const text_style& style,
                           int64_t now_unix_ms);

} // namespace roscell::cli
