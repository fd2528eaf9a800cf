#include "tools/roscell/top/model/event_questions.hpp"

#include <algorithm>
#include <iterator>

namespace roscell::cli::top {

namespace {

/// Beginnings of the names of events after which nodes, tasks or instances are
/// others than before.
constexpr std::string_view changes_of_the_cell[] = {
    "node_",     "task_",   "instance_",         "cell_",
    "cells_",    "step_",   "allocation_chosen", "skill_instance_died",
    "transfer_", "switch_", "coordinator_lost"};

constexpr std::string_view changes_of_skills[] = {
    "node_joined", "node_left", "node_lost", "cell_joined", "skill_refused"};

bool begins_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

template <class Words>
bool begins_with_any(std::string_view what, const Words& words) {
  return std::any_of(std::begin(words), std::end(words),
                     [&](auto word) { return begins_with(what, word); });
}

} // namespace

questions questions_after(std::string_view what) {
  questions result;
  result.cell = begins_with_any(what, changes_of_the_cell);
  result.skills = begins_with_any(what, changes_of_skills);
  return result;
}

} // namespace roscell::cli::top
