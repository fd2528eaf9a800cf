#pragma once

#include "messages/instance.hpp"
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

/// Says at each input which step of the task writes it (`io_endpoint::from`),
/// so that a node can name it when nothing comes. An input that no step of the
/// task writes, or that a program outside of it does, stays as it is.
void name_upstream_steps(std::vector<instance_spec>& task);

} // namespace roscell
