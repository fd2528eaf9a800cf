#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/vision/brightness.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

using namespace roscell;

namespace {

/// Checks that what is emitted can be read.
class checking_emitter : public engine::emitter {
  void write(engine::frame result, std::size_t port) override {
    if (port == 0)
      ros2::deserialize<ros2::tf2_msgs::tf_message>(result.payload);
    else if (port == 1)
      nlohmann::json::parse(result.payload);
    else
      vision::decode_picture(result.payload, vision::pixel_format::bgr8);
  }
};

engine::environment make_environment() {
  engine::environment env;
  env.inputs = {
      {"ros2", "/image", ros2::sensor_msgs::image::type_name},
      {"ros2", "/camera_info", ros2::sensor_msgs::camera_info::type_name}};
  env.outputs = {{"ros2", "/tf", ros2::tf2_msgs::tf_message::type_name},
                 {"file", "/poses", "application/json"},
                 {"file", "/pictures/", "image/png"}};
  env.parameters = engine::parameters::parse(R"({"picture_rate_hz": 0})");
  return env;
}

void offer(pose::pose_estimator& estimator, std::size_t port, const char* type,
           std::string payload) {
  engine::frame input;
  input.port = port;
  input.data_type = type;
  input.payload = std::move(payload);
  checking_emitter output;
  try {
    estimator.process(input, output);
  } catch (const ros2::cdr_error&) {
    // The engine reports it.
  } catch (const std::invalid_argument&) {
    // An image that is too large.
  } catch (const engine::unusable_input&) {
    // An encoding that cannot be used.
  } catch (const vision::image_error&) {
    // A picture without pixels cannot be written.
  }
}

/// As rectify does it.
void separate_numbers(const std::string& message) {
  std::vector<std::uint8_t> storage;
  try {
    const auto image = ros2::view_image(message);
    ros2::serialize(vision::to_plain_numbers(image, storage));
  } catch (const ros2::cdr_error&) {
    // The engine reports it.
  } catch (const engine::unusable_input&) {
    // An encoding that cannot be used.
  }
}

} // namespace

/// Whatever comes from a camera, first a CameraInfo whose length the first two
/// bytes tell, then an image, it gives readable results or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  if (size < 2)
    return 0;
  pose::pose_estimator estimator{make_environment(), [](const std::string&) {}};
  const std::string bytes{reinterpret_cast<const char*>(data) + 2, size - 2};
  const auto length = std::min<size_t>(data[0] + 256U * data[1], bytes.size());
  offer(estimator, 1, ros2::sensor_msgs::camera_info::type_name,
        bytes.substr(0, length));
  offer(estimator, 0, ros2::sensor_msgs::image::type_name,
        bytes.substr(length));
  separate_numbers(bytes.substr(length));
  return 0;
}
