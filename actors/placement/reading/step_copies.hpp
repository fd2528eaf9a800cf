#pragma once

#include "messages/failure.hpp"
#include "messages/task.hpp"

#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// A pipeline in which a step with `copies: 3` is three steps, "<id>-1" to
/// "<id>-3", each with its number in place of `${copy}`; one that is meant as a
/// whole text of a parameter is a number. Others stay as they are, so that it
/// may be done again.
///
/// Errors: schema_violation, with the place: outputs that all copies would
/// share, an input from all copies, an id that is too long or taken, more steps
/// than a task may have.
std::variant<std::vector<task_step>, failure>
with_copies(const std::vector<task_step>& pipeline,
            const std::string& pointer = "/pipeline");

} // namespace roscell
