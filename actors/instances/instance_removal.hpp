#pragma once

#include "actors/instances/container_supervisor.hpp"

#include <caf/result.hpp>

#include <string>

/// INTERNAL to the container supervisor: how instances leave its table.
namespace roscell {

using container_supervisor_pointer =
    container_supervisor_actor::stateful_pointer<container_supervisor_state>;

/// Null if there is none of that id.
supervised_instance* find_instance(container_supervisor_pointer self,
                                   const std::string& instance);

/// Removes an ended instance's record and row, and puts its log into the
/// history.
void clean_instance(container_supervisor_pointer self,
                    const std::string& instance);

/// Keeps the newest rows of ended instances only, of older ones those that the
/// coordinator does not know to have ended, without what they left.
void trim_ended(container_supervisor_pointer self);

/// The coordinator keeps that these have ended.
void acknowledge_ends(container_supervisor_pointer self,
                      const std::vector<std::string>& instances);

/// An instance that is to go is not stop-safe yet: whoever wants it gone hears
/// that.
void on_removal_waits(container_supervisor_pointer self,
                      const instance_row& row);

/// Ends one instance or all of a task, and replies when they are gone or wait
/// to be stop-safe.
caf::result<instances_removed>
remove_instances(container_supervisor_pointer self,
                 const instance_removal& request);

} // namespace roscell
