#pragma once

#include "messages/messages.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A task and where its steps are to run.
struct allocated_task {
  task_request request;
  std::vector<resolved_step> steps;
  task_plan plan;
};

/// The instances that an allocation asks for, in the order of the steps, each
/// with an id of its own.
std::vector<instance_spec> make_specs(const allocated_task& task);

} // namespace roscell
