#pragma once

#include "messages/allocation_report.hpp"
#include "messages/failure.hpp"
#include "tools/roscell/view/table.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// An allocation for people: a row per step, the score with its terms, a bar
/// for each resource before and after, the alternative if one was asked for,
/// and who was rejected.
std::string plan_view(const task_plan& plan, const text_style& style);

/// Who was rejected, as the details of a failure tell; none if they do not.
std::vector<rejected_candidate> rejected_in(const failure& why);

/// Who was rejected for which step and why; "no rejected candidates" if empty.
std::string rejected_view(const std::vector<rejected_candidate>& rejected,
                          const text_style& style);

} // namespace roscell::cli
