#include "skills/pose_estimation/camera_model.hpp"
#include "skills/vision/calibration.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

using namespace roscell;

/// Whatever is in a calibration, it gives a camera, a reason why not, or an
/// error. Texts are bounded as those of files are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  const std::string text{reinterpret_cast<const char*>(data),
                         std::min<size_t>(size, 65536)};
  ros2::sensor_msgs::camera_info info;
  try {
    info = vision::parse_calibration(text);
  } catch (const std::runtime_error&) {
    return 0;
  }
  for (auto rectified : {false, true}) {
    const auto model = pose::camera_model::of(info, rectified);
    if (const auto* camera = std::get_if<pose::camera_model>(&model))
      camera->distort(camera->undistort({100, 200}));
    else if (std::get<std::string>(model).empty())
      std::abort();
  }
  return 0;
}
