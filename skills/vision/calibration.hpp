#pragma once

#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/environment.hpp"

#include <optional>
#include <string>

namespace roscell::vision {

/// How a camera maps directions to pixels, as sensor_msgs/msg/CameraInfo, from
/// the parameters of a skill:
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | fx, fy | - | focal lengths in pixels
/// | cx, cy | - | principal point in pixels; the middle of the upper left
///   pixel is (0, 0)
/// | distortion | [] | coefficients k1, k2, p1, p2, k3 of plumb_bob, 8, 12 or
/// 14
///   of rational_polynomial, or 4 of equidistant
/// | distortion_model | by their number | one of these three; equidistant must
/// be
///   said
///
/// Nothing if none of them is given. Width and height stay 0, which means: of
/// any size. Throws start_error when they are incomplete or make no sense.
std::optional<ros2::sensor_msgs::camera_info>
calibration_of(const engine::parameters& options);

/// The calibration in a text as camera_calibration and camera_info_manager
/// write it in YAML, or OpenCV's FileStorage; JSON with the same names is a
/// part of YAML. Throws std::runtime_error, naming what is wrong.
ros2::sensor_msgs::camera_info parse_calibration(const std::string& text);

/// Reads such a text. Throws start_error, naming the file and what is wrong.
ros2::sensor_msgs::camera_info read_calibration(const std::string& path);

/// The calibration beside the images of an input: if its endpoint is a folder,
/// the file in it that parameter `camera_file` names, or `camera.json`,
/// `camera.yaml` or `camera_info.yaml`, whichever is found first. An absolute
/// `camera_file` is taken for an input of any protocol. Throws start_error
/// when the file is not as it should be, or `camera_file` is not there.
std::optional<ros2::sensor_msgs::camera_info>
calibration_beside(const engine::stream& input,
                   const engine::parameters& options);

} // namespace roscell::vision
