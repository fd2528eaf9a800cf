#pragma once

#include "messages/allocation_report.hpp"
#include "messages/rebalance.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"
#include "tools/roscell/view/table.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// Where the steps of a task run now.
std::string accepted_view(const task_accepted& task, const text_style& style);

std::string restarted_view(const task_restarted& task, const text_style& style);

std::string terminated_view(const task_terminated& task);

/// "waits for 'arm/grasp' on arm-1 to be stop-safe".
std::string waiting_text(const safety_wait& wait);

/// All that somebody needs to use an operation: its models, their deployments
/// and parameters, what it takes and gives, and who has it. The rows are all of
/// one operation, at least one.
std::string skill_view(const std::vector<skill_row>& rows,
                       const text_style& style);

/// The moves with their gains, and the totals before and after them.
std::string rebalance_view(const cell_rebalanced& report,
                           const text_style& style);

} // namespace roscell::cli
