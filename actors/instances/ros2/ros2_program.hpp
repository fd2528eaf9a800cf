#pragma once

#include "messages/failure.hpp"
#include "messages/inside/link.hpp"
#include "messages/instance.hpp"
#include "messages/skill.hpp"
#include "schemas/parameters/declared_parameter.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace roscell {

/// A word that ROS 2 takes for a name: other characters become '_'. A skill of
/// our engine makes the name of its DDS participant of its instance in the same
/// way.
std::string ros_name(std::string_view text);

/// What the node's discovery server must know of an instance whose skill has
/// counted `frames`, which only one of our engine does: it opens all its topics
/// before it is ready, by a participant that is named for the instance. None:
/// it has no ROS 2 topics.
std::optional<watch_endpoints>
engine_ends(const instance_spec& spec, const std::vector<stream_count>& frames);

/// How a stock ROS 2 program is run as a step, and how it is known when it
/// does.
struct ros2_start {
  std::vector<std::string> command;
  std::map<std::string, std::string> environment;
  watch_endpoints endpoints; ///< That it has once it is ready.
};

/// An executable gets `--ros-args`: its node's name and namespace ("/task",
/// "step"), the topics of the step in place of its own, the parameters, and an
/// enclave of its own, which names its DDS participant. A launch file gets its
/// arguments, and topics and parameters as such; all that it starts counts.
/// Refused when a topic stands for an end that the step has not, and when a
/// parameter cannot be given to such a program.
/// @param declared by the model; the values get these types.
std::variant<ros2_start, failure>
ros2_start_of(const ros2_program& program, const instance_spec& spec,
              const declared_parameters& declared = {});

/// The same for the program of a skill, which has one.
std::variant<ros2_start, failure> ros2_start_of(const skill_descriptor& skill,
                                                const instance_spec& spec);

} // namespace roscell
