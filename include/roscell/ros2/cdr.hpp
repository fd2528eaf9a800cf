#pragma once

#include "roscell/ros2/cdr_error.hpp"

#include <string>
#include <string_view>

/// ROS 2 messages as bytes: the payload of a frame of the `ros2` protocol.
/// That is plain CDR (XCDR1), behind the 4 bytes that say so and in which byte
/// order. There are these two functions for every struct that is made from a
/// definition, and all threads may call them.
namespace roscell::ros2 {

/// Little endian. Throws cdr_error when the message cannot be written: more
/// items than its definition allows, or than 2^32.
template <class T>
std::string serialize(const T& message);

/// Takes either byte order. `payload` may come from anybody: every length is
/// checked against what is left of it before memory is taken, and against the
/// definition. Throws cdr_error. What numbers mean is not looked at: for images
/// `view_image` does.
template <class T>
T deserialize(std::string_view payload);

} // namespace roscell::ros2
