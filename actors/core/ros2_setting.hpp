#pragma once

#include "messages/instance.hpp"

namespace roscell {

/// Whether clients of ROS 2 may change parameters of the instances of a cell
/// while they run, by the service `set_parameters` of their nodes. By DDS
/// nobody proves who he is, so they may not where the cell was not set up so.
///
/// It is a variable of the instance: its program passes nothing on without it,
/// and its node carries none out. So it counts for what is started from then
/// on.
inline constexpr const char* ros2_setting_variable =
    "ROSCELL_ROS2_SET_PARAMETERS";

/// Lets them, or not.
/// @param allowed false: the variable is taken out, whoever has put it there.
void let_ros2_set_parameters(instance_spec& spec, bool allowed);

/// What the spec of an instance says of it.
bool lets_ros2_set_parameters(const instance_spec& spec);

} // namespace roscell
