#pragma once

#include <string_view>

/// How streams get from step to step: what `protocol` of an input or output
/// says. A skill may bring one of its own; nobody wires such streams.
namespace roscell::protocols {

/// A topic of ROS 2, on the cell's DDS domain; wired by its name.
inline constexpr std::string_view ros2 = "ros2";

/// A file, a FIFO or a folder of the host, where one frame is a line or a file;
/// wired by its path, so both steps run on one node.
inline constexpr std::string_view file = "file";

/// A camera, a film or an address of one; an input only.
inline constexpr std::string_view video = "video";

/// Frames that the skills of one program pass on within it; wired by its name.
inline constexpr std::string_view actor = "actor";

} // namespace roscell::protocols
