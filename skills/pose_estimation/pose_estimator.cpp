#include "skills/pose_estimation/pose_estimator.hpp"

#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/camera_source.hpp"
#include "skills/pose_estimation/overlay.hpp"
#include "skills/vision/brightness.hpp"
#include "skills/vision/calibration.hpp"
#include "skills/vision/image_codec.hpp"

#include <algorithm>
#include <utility>

namespace roscell::pose {

namespace {

using engine::start_error;
using engine::typed_outputs;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::compressed_image;
using ros2::sensor_msgs::image;

/// "photo.jpg" becomes "photo.png".
std::string png_name(const std::string& name) {
  return name.empty() ? name : name.substr(0, name.find_last_of('.')) + ".png";
}

/// "/scene_1/image" becomes "scene_1_image.png".
std::string live_picture_name(const std::string& endpoint) {
  auto begin = std::min(endpoint.find_first_not_of('/'), endpoint.size());
  auto name = endpoint.substr(begin) + ".png";
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string to_line(const frame_result& result) {
  using nlohmann::json;
  // Names from outside may hold any byte.
  return to_json(result).dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace

pose_estimator::pose_estimator(const engine::environment& env)
    : pose_estimator(env, [](const std::string& line) {
        engine::log_line("pose_estimation: " + line);
      }) {
  // nop
}

pose_estimator::pose_estimator(const engine::environment& env,
                               engine::say_function say)
    : paired_executor(env.inputs), say_(std::move(say)),
      rectified_(env.parameters.flag("rectified", false)),
      frame_id_(env.parameters.text("frame_id", "camera")),
      picture_rate_hz_(
          env.parameters.number("picture_rate_hz", 1, 0, 1'000'000)),
      given_(vision::calibration_of(env.parameters)), accepted_(env.parameters),
      finder_(env.parameters, say_), broken_files_(say_) {
  check_streams(env);
  add_sources(env);
}

void pose_estimator::add_sources(const engine::environment& env) {
  const auto images = image_ports().size();
  const auto infos = info_ports().size();
  if (images == 0 || infos > images)
    throw start_error("the step has " + std::to_string(images) + " image and "
                      + std::to_string(infos)
                      + " CameraInfo inputs; give each image input at most one "
                        "CameraInfo");
  for (std::size_t k = 0; k < images; ++k)
    add_source(env, image_ports()[k], k < infos);
  auto count = sources_.size();
  typed_outputs transforms{env.outputs, ros2::tf2_msgs::tf_message::type_name,
                           count};
  typed_outputs detections{
      env.outputs, ros2::apriltag_msgs::april_tag_detection_array::type_name,
      count};
  typed_outputs poses{env.outputs,
                      ros2::vision_msgs::detection3_d_array::type_name, count};
  typed_outputs lines{env.outputs, "application/json", count};
  typed_outputs pictures{env.outputs, "image/png", count};
  const auto frame_ids = texts_of_cameras(env.parameters, "frame_ids", count);
  const auto prefixes = texts_of_cameras(env.parameters, "tag_prefixes", count);
  for (std::size_t k = 0; k < count; ++k) {
    sources_[k].frame_id = frame_ids[k];
    sources_[k].prefix = prefixes[k];
    sources_[k].transforms = transforms.of_source(k);
    sources_[k].detections = detections.of_source(k);
    sources_[k].poses = poses.of_source(k);
    sources_[k].lines = lines.of_source(k);
    sources_[k].pictures = pictures.of_source(k);
  }
}

void pose_estimator::add_source(const engine::environment& env,
                                std::size_t port, bool expects_info) {
  const auto& input = env.inputs[port];
  auto known = given_;
  expects_info = expects_info && !known;
  if (!known && !expects_info)
    known = vision::calibration_beside(input, env.parameters);
  auto is_live = is_image_message(input.data_type) && picture_rate_hz_ > 0;
  sources_.push_back({{input.endpoint, expects_info, rectified_, say_},
                      input.endpoint,
                      "",
                      "",
                      is_live ? live_picture_name(input.endpoint) : "",
                      engine::pacer{picture_rate_hz_}});
  if (known)
    sources_.back().camera.calibrate({}, *known);
}

void pose_estimator::calibrate(std::size_t camera, const engine::frame& info) {
  if (!given_)
    sources_.at(camera).camera.calibrate(
        info.time, ros2::deserialize<camera_info>(info.payload));
}

bool pose_estimator::should_wait(std::size_t camera,
                                 const engine::frame& image) {
  return sources_.at(camera).camera.should_wait(image.time);
}

void pose_estimator::process_image(const engine::frame& input,
                                   engine::emitter& output) {
  if (input.data_type == compressed_image::type_name)
    return process_compressed(input, output);
  if (input.data_type != image::type_name)
    return process_file(input, output);
  const auto sent = ros2::view_image(input.payload);
  accepted_.check(sent.encoding);
  find_and_emit(sent, input, output);
}

void pose_estimator::release() {
  // Everything is given back by destructors.
}

void pose_estimator::process_file(const engine::frame& input,
                                  engine::emitter& output) {
  const auto& source = sources_.at(camera_of(input.port));
  vision::picture picture;
  try {
    picture = vision::decode_picture(input.payload, format_for(source));
  } catch (const vision::image_error& e) {
    broken_files_.skip(input.name, e.what());
    return output.give_nothing("'" + input.name + "': " + e.what());
  }
  find_and_emit(view(picture, {ros2::to_time(input.time), frame_id_}), input,
                output);
}

void pose_estimator::process_compressed(const engine::frame& input,
                                        engine::emitter& output) {
  auto message = ros2::deserialize<compressed_image>(input.payload);
  const auto& source = sources_.at(camera_of(input.port));
  auto picture = vision::decompress(message, format_for(source));
  find_and_emit(view(picture, message.header), input, output);
}

/// Colours are of use where pictures are drawn only.
vision::pixel_format pose_estimator::format_for(const source& from) {
  return from.pictures == typed_outputs::none ? vision::pixel_format::mono8
                                              : vision::pixel_format::bgr8;
}

void pose_estimator::find_and_emit(const ros2::image_view& image,
                                   const engine::frame& input,
                                   engine::emitter& output) {
  auto number = camera_of(input.port);
  auto& source = sources_.at(number);
  auto camera = source.camera.model_for(input.time, image.width, image.height);
  auto result = find_tags(image, number, camera);
  result.frame_name = input.name;
  auto emit = [&](std::size_t port, std::string payload) {
    engine::frame message;
    message.payload = std::move(payload);
    message.name = input.name;
    output.emit(std::move(message), port);
  };
  if (source.transforms != typed_outputs::none)
    emit(source.transforms, ros2::serialize(to_tf_message(result)));
  if (source.detections != typed_outputs::none)
    emit(source.detections, ros2::serialize(to_detection_array(result)));
  if (source.poses != typed_outputs::none)
    emit(source.poses, ros2::serialize(to_detection3d_array(result)));
  if (source.lines != typed_outputs::none)
    emit(source.lines, to_line(result));
  if (source.pictures != typed_outputs::none)
    emit_picture(source, result, image, camera, output);
}

void pose_estimator::emit_picture(source& from, const frame_result& result,
                                  const ros2::image_view& image,
                                  const std::optional<camera_model>& camera,
                                  engine::emitter& output) {
  auto is_live = !from.live_name.empty();
  if (is_live && !from.picture_pace.take_turn())
    return;
  engine::frame message;
  message.payload = vision::encode_png(draw(result, image, camera));
  message.name = is_live ? from.live_name : png_name(result.frame_name);
  output.emit(std::move(message), from.pictures);
}

frame_result
pose_estimator::find_tags(const ros2::image_view& image, std::size_t number,
                          const std::optional<camera_model>& camera) {
  auto start = std::chrono::steady_clock::now();
  const auto& from = sources_[number];
  frame_result result;
  result.source = number;
  result.header = image.header;
  if (!from.frame_id.empty())
    result.header.frame_id = from.frame_id;
  result.width = image.width;
  result.height = image.height;
  finder_.find(vision::to_gray(image, gray_buffer_), camera,
               {number, from.transforms, from.name, from.prefix}, result);
  result.processing_time = std::chrono::steady_clock::now() - start;
  result.age = std::chrono::system_clock::now()
               - ros2::to_time_point(image.header.stamp);
  return result;
}

vision::picture
pose_estimator::draw(const frame_result& result, const ros2::image_view& image,
                     const std::optional<camera_model>& camera) const {
  vision::picture picture{image.width, image.height, vision::pixel_format::bgr8,
                          vision::to_bgr(image)};
  draw_overlay(result, camera, picture);
  return picture;
}

} // namespace roscell::pose
