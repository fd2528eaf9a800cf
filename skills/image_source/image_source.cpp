#include "skills/image_source/image_source.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/log_line.hpp"
#include "skills/vision/calibration.hpp"

#include <chrono>

namespace roscell::source {

namespace {

using engine::start_error;
using engine::typed_outputs;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::compressed_image;
using ros2::sensor_msgs::image;

vision::pixel_format format_of(const engine::parameters& options) {
  auto encoding = options.text("encoding", "mono8");
  if (encoding == "mono8")
    return vision::pixel_format::mono8;
  if (encoding == "bgr8")
    return vision::pixel_format::bgr8;
  throw start_error("parameter 'encoding' is '" + encoding
                    + "', but must be mono8 or bgr8");
}

void check_outputs(const engine::environment& env) {
  for (const auto& out : env.outputs)
    if (out.data_type != image::type_name
        && out.data_type != compressed_image::type_name
        && out.data_type != camera_info::type_name)
      throw start_error("output '" + out.endpoint + "' has the type '"
                        + out.data_type
                        + "'; this skill gives sensor_msgs/msg/Image, "
                          "sensor_msgs/msg/CompressedImage and "
                          "sensor_msgs/msg/CameraInfo");
}

/// Named and timed like the picture, so that all its messages agree.
engine::frame message_of(const engine::frame& input,
                         const ros2::std_msgs::header& header,
                         std::string payload) {
  engine::frame result;
  result.payload = std::move(payload);
  result.name = input.name;
  result.time = ros2::to_time_point(header.stamp);
  return result;
}

} // namespace

image_source::image_source(const engine::environment& env)
    : image_source(env, [](const std::string& line) {
        engine::log_line("image_source: " + line);
      }) {
  // nop
}

image_source::image_source(const engine::environment& env,
                           engine::say_function say)
    : say_(std::move(say)),
      frame_id_(env.parameters.text("frame_id", "camera")),
      format_(format_of(env.parameters)), compression_(env.parameters),
      broken_files_(say_) {
  check_outputs(env);
  for (const auto& input : env.inputs)
    add_camera(env, input);
  auto count = cameras_.size();
  typed_outputs images{env.outputs, image::type_name, count};
  typed_outputs compressed{env.outputs, compressed_image::type_name, count};
  typed_outputs infos{env.outputs, camera_info::type_name, count};
  for (std::size_t k = 0; k < count; ++k) {
    cameras_[k].images = images.of_source(k);
    cameras_[k].compressed = compressed.of_source(k);
    cameras_[k].infos = infos.of_source(k);
  }
}

void image_source::add_camera(const engine::environment& env,
                              const engine::stream& input) {
  camera eye;
  eye.name = input.endpoint;
  eye.calibration = vision::calibration_of(env.parameters);
  if (!eye.calibration)
    eye.calibration = vision::calibration_beside(input, env.parameters);
  cameras_.push_back(std::move(eye));
}

void image_source::process(const engine::frame& input,
                           engine::emitter& output) {
  auto& eye = cameras_.at(input.port);
  if (input.data_type != image::type_name) {
    process_file(input, eye, output);
    return;
  }
  auto view = ros2::view_image(input.payload);
  if (eye.images != typed_outputs::none)
    output.emit(message_of(input, view.header, input.payload), eye.images);
  emit_beside(eye, view, input, output);
}

void image_source::release() {
  // Everything is given back by destructors.
}

void image_source::process_file(const engine::frame& input, camera& eye,
                                engine::emitter& output) {
  vision::picture picture;
  try {
    picture = vision::decode_picture(input.payload, format_);
  } catch (const vision::image_error& e) {
    broken_files_.skip(input.name, e.what());
    return output.give_nothing("'" + input.name + "': " + e.what());
  }
  ros2::std_msgs::header header{ros2::to_time(std::chrono::system_clock::now()),
                                frame_id_};
  auto view = vision::view(picture, header);
  if (eye.images != typed_outputs::none)
    output.emit(message_of(input, header, ros2::serialize(view)), eye.images);
  emit_beside(eye, view, input, output);
}

void image_source::emit_beside(camera& eye, const ros2::image_view& image,
                               const engine::frame& input,
                               engine::emitter& output) {
  if (eye.compressed != typed_outputs::none)
    output.emit(message_of(input, image.header,
                           ros2::serialize(compression_.compress(image))),
                eye.compressed);
  emit_info(eye, image, input, output);
}

void image_source::emit_info(camera& eye, const ros2::image_view& image,
                             const engine::frame& input,
                             engine::emitter& output) {
  if (eye.infos == typed_outputs::none)
    return;
  auto info = eye.calibration.value_or(camera_info{});
  info.header = image.header;
  // Intrinsics from parameters, and none at all, are for any size.
  if (info.width == 0 && info.height == 0) {
    info.width = image.width;
    info.height = image.height;
  }
  auto fits = info.width == image.width && info.height == image.height;
  if (!fits && !eye.size_said)
    say_("'" + eye.name + "' has pictures of " + std::to_string(image.width)
         + " x " + std::to_string(image.height)
         + " pixels, but a calibration for " + std::to_string(info.width)
         + " x " + std::to_string(info.height) + "; correct one of them");
  eye.size_said = !fits;
  output.emit(message_of(input, image.header, ros2::serialize(info)),
              eye.infos);
}

} // namespace roscell::source
