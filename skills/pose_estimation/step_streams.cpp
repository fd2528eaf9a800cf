#include "skills/pose_estimation/step_streams.hpp"

#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/ros2/vision_msgs.hpp"
#include "roscell/skill/errors.hpp"

namespace roscell::pose {

using engine::start_error;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::compressed_image;
using ros2::sensor_msgs::image;

bool is_camera_info(const engine::stream& input) {
  return input.data_type == camera_info::type_name;
}

bool is_image_message(const std::string& data_type) {
  return data_type == image::type_name
         || data_type == compressed_image::type_name;
}

void check_streams(const engine::environment& env) {
  for (const auto& in : env.inputs)
    if (!is_camera_info(in) && !is_image_message(in.data_type)
        && in.data_type.compare(0, 6, "image/") != 0)
      throw start_error("input '" + in.endpoint + "' has the type '"
                        + in.data_type
                        + "'; this skill takes sensor_msgs/msg/Image, "
                          "sensor_msgs/msg/CompressedImage, image/png, "
                          "image/jpeg and sensor_msgs/msg/CameraInfo");
  for (const auto& out : env.outputs)
    if (out.data_type != ros2::tf2_msgs::tf_message::type_name
        && out.data_type
               != ros2::apriltag_msgs::april_tag_detection_array::type_name
        && out.data_type != ros2::vision_msgs::detection3_d_array::type_name
        && out.data_type != "application/json" && out.data_type != "image/png")
      throw start_error("output '" + out.endpoint + "' has the type '"
                        + out.data_type
                        + "'; this skill gives tf2_msgs/msg/TFMessage, "
                          "apriltag_msgs/msg/AprilTagDetectionArray, "
                          "vision_msgs/msg/Detection3DArray, "
                          "application/json and image/png");
}

std::vector<std::string> texts_of_cameras(const engine::parameters& options,
                                          const char* name,
                                          std::size_t cameras) {
  auto result = options.texts(name, {}, 64);
  if (!result.empty() && result.size() != cameras)
    throw start_error("parameter '" + std::string{name} + "' has "
                      + std::to_string(result.size()) + " texts, but the step "
                      + std::to_string(cameras)
                      + " image inputs; give one for each, in their order");
  result.resize(cameras);
  return result;
}

} // namespace roscell::pose
