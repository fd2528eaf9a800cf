#include "skills/rectify/rectifier.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/log_line.hpp"
#include "skills/vision/brightness.hpp"

#include <cmath>
#include <utility>

namespace roscell::rectify {

namespace {

using engine::start_error;
using engine::typed_outputs;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::image;

void check_types(const std::vector<engine::stream>& ends, const char* verb) {
  for (const auto& end : ends)
    if (end.data_type != image::type_name
        && end.data_type != camera_info::type_name)
      throw start_error("'" + end.endpoint + "' has the type '" + end.data_type
                        + "'; this skill " + verb
                        + " sensor_msgs/msg/Image and "
                          "sensor_msgs/msg/CameraInfo");
}

/// The raw image with other pixels, whose rows have no gaps.
std::string rectified(const ros2::image_view& raw, const pixel_map& map) {
  std::vector<std::uint8_t> storage;
  auto result = vision::to_plain_numbers(raw, storage);
  const auto pixels = remap(result, map);
  result.step = static_cast<std::uint32_t>(pixels.size() / raw.height);
  result.data = pixels.data();
  result.size = pixels.size();
  return ros2::serialize(result);
}

} // namespace

rectifier::rectifier(const engine::environment& env)
    : rectifier(env, [](const std::string& line) {
        engine::log_line("rectify: " + line);
      }) {
  // nop
}

rectifier::rectifier(const engine::environment& env,
                     const engine::say_function& say)
    : paired_executor(env.inputs) {
  check_types(env.inputs, "takes");
  check_types(env.outputs, "gives");
  const auto& images = image_ports();
  const auto& infos = info_ports();
  if (images.empty() || images.size() != infos.size())
    throw start_error("the step has " + std::to_string(images.size())
                      + " image and " + std::to_string(infos.size())
                      + " CameraInfo inputs; give each image input its "
                        "CameraInfo");
  typed_outputs to_images{env.outputs, image::type_name, images.size()};
  typed_outputs to_infos{env.outputs, camera_info::type_name, images.size()};
  for (std::size_t k = 0; k < images.size(); ++k)
    sources_.push_back({raw_camera{env.inputs[images[k]].endpoint, say},
                        to_images.of_source(k), to_infos.of_source(k)});
}

void rectifier::calibrate(std::size_t camera, const engine::frame& info) {
  sources_.at(camera).camera.calibrate(
      info.time, ros2::deserialize<camera_info>(info.payload));
}

bool rectifier::should_wait(std::size_t camera, const engine::frame& image) {
  return sources_.at(camera).camera.should_wait(image.time);
}

void rectifier::release() {
  // Everything is given back by destructors.
}

void rectifier::process_image(const engine::frame& input,
                              engine::emitter& output) {
  auto& from = sources_.at(camera_of(input.port));
  auto raw = ros2::view_image(input.payload);
  if (!from.camera.is_ready_for(input.time, raw.width, raw.height))
    return output.give_nothing(from.camera.problem());
  if (from.images != typed_outputs::none) {
    const auto* map = from.camera.map();
    output.emit(map == nullptr ? input.payload : rectified(raw, *map),
                from.images);
  }
  if (from.infos != typed_outputs::none) {
    auto info = from.camera.info();
    info.header = raw.header;
    output.emit(ros2::serialize(info), from.infos);
  }
}

namespace {

using ros2::sensor_msgs::camera_info;

/// Images and CameraInfo come on different ways, so a few images may overtake
/// the first CameraInfo of a healthy camera.
constexpr auto patient_images = 5U;

bool same_calibration(camera_info a, const camera_info& b) {
  a.header = b.header;
  return a == b;
}

bool has_focal_lengths(double fx, double fy) {
  return std::isfinite(fx) && std::isfinite(fy) && fx > 0 && fy > 0;
}

/// What is wrong with the description of sent images, or nothing.
std::string check(const camera_info& info) {
  if (info.width == 0 || info.height == 0)
    return "is for images without pixels; calibrate the camera";
  if (info.k == camera_info{}.k)
    return "is all zero, so the camera is not calibrated; calibrate it";
  if (!has_focal_lengths(info.k[0], info.k[4]))
    return "has no positive focal lengths in K; calibrate the camera";
  if (!has_focal_lengths(info.p[0], info.p[5]))
    return "has no positive focal lengths in P, which says what the rectified "
           "image is to be; calibrate the camera";
  if (!can_be_inverted(info))
    return "has matrices P and R that cannot be inverted; calibrate the camera";
  return "";
}

std::string size(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

} // namespace

raw_camera::raw_camera(const std::string& name, engine::say_function say)
    : name_(name), say_(say),
      complaint_("'" + name + "' gives no rectified images: ",
                 "'" + name + "': the calibration is good now, images follow",
                 std::move(say)) {
  // nop
}

void raw_camera::calibrate(stamp at, const camera_info& info) {
  calibrations_.add(at, info);
}

void raw_camera::use(const camera_info& info) {
  // It comes with every image, and hardly ever changes.
  if (info_ && same_calibration(*info_, info))
    return;
  if (info_ && fault_.empty() && !std::exchange(change_said_, true))
    say_("'" + name_
         + "': its calibration changes while it runs; each image is rectified "
           "by the CameraInfo of its stamp");
  info_ = info;
  sent_ = vision::describe_sent_images(info);
  map_.reset();
  fault_ = check(sent_);
  auto read = vision::lens::of(info);
  if (const auto* wrong = std::get_if<std::string>(&read))
    fault_ = fault_.empty() ? *wrong : fault_;
  else
    lens_ = std::get<vision::lens>(read);
}

bool raw_camera::is_ready_for(stamp image, std::uint32_t width,
                              std::uint32_t height) {
  if (const auto* known = calibrations_.of(image))
    use(*known);
  if (!info_ && ++early_images_ < patient_images)
    return false;
  problem_ = problem_with(width, height);
  complaint_.update(problem_);
  return problem_.empty();
}

std::string raw_camera::problem_with(std::uint32_t width,
                                     std::uint32_t height) const {
  if (!info_)
    return "no CameraInfo has come; see that the camera publishes it";
  if (!fault_.empty())
    return "its CameraInfo " + fault_;
  if (sent_.width != width || sent_.height != height)
    return "its CameraInfo is for images of " + size(sent_.width, sent_.height)
           + ", but they have " + size(width, height)
           + " pixels; calibrate the camera at this size";
  return "";
}

const pixel_map* raw_camera::map() {
  if (!lens_.distorts())
    return nullptr;
  if (!map_)
    map_ = make_map(sent_, lens_);
  return &*map_;
}

} // namespace roscell::rectify
