#pragma once

#include "messages/allocation_report.hpp"
#include "messages/failure.hpp"
#include "messages/formation.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/views.hpp"

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

// The replies about nodes that move, as text for people.

std::string formation_view(const cell_formed& formed, const view_style& style);

/// What helps the names that failed, each advice once.
std::vector<std::string> hints_of(const cell_formed& formed);

std::string transferred_view(const node_transferred& moved,
                             const view_style& style);
std::string released_view(const node_released& moved, const view_style& style);
std::string transfers_view(const transfer_description& transfers,
                           const view_style& style);

} // namespace roscell::cli
