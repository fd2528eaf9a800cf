#pragma once

#include <string>
#include <string_view>

namespace roscell {

/// A word that ROS 2 takes for a name: other characters become '_'. A skill of
/// our engine makes the name of its DDS participant of its instance in the same
/// way.
std::string ros_name(std::string_view text);

} // namespace roscell
