#include "skills/convert/converter.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/typed_ports.hpp"
#include "skills/vision/brightness.hpp"
#include "skills/vision/image_codec.hpp"

#include <utility>

namespace roscell::convert {

namespace {

using engine::start_error;
using ros2::image_view;
using ros2::sensor_msgs::compressed_image;
using ros2::sensor_msgs::image;

std::string encoding_of(const engine::parameters& options) {
  auto encoding = options.text("encoding", "bgr8");
  if (encoding != "mono8" && encoding != "rgb8" && encoding != "bgr8")
    throw start_error("parameter 'encoding' is '" + encoding
                      + "', but must be mono8, rgb8 or bgr8");
  return encoding;
}

void check_types(const engine::environment& env) {
  for (const auto& in : env.inputs)
    if (in.data_type != image::type_name
        && in.data_type != compressed_image::type_name)
      throw start_error("input '" + in.endpoint + "' has the type '"
                        + in.data_type
                        + "'; this skill takes sensor_msgs/msg/Image and "
                          "sensor_msgs/msg/CompressedImage");
  for (const auto& out : env.outputs)
    if (out.data_type != image::type_name)
      throw start_error("output '" + out.endpoint + "' has the type '"
                        + out.data_type
                        + "'; this skill gives sensor_msgs/msg/Image");
}

/// Blue first becomes red first, or the reverse.
void swap_colours(std::vector<std::uint8_t>& pixels) {
  for (std::size_t i = 0; i + 2 < pixels.size(); i += 3)
    std::swap(pixels[i], pixels[i + 2]);
}

} // namespace

converter::converter(const engine::environment& env)
    : encoding_(encoding_of(env.parameters)), accepted_(env.parameters) {
  check_types(env);
  engine::typed_outputs images{env.outputs, image::type_name,
                               env.inputs.size()};
  for (std::size_t k = 0; k < env.inputs.size(); ++k)
    outputs_.push_back(images.of_source(k));
}

void converter::process(const engine::frame& input, engine::emitter& output) {
  const auto port = outputs_.at(input.port);
  if (port == engine::typed_outputs::none)
    return;
  if (input.data_type == image::type_name) {
    const auto source = ros2::view_image(input.payload);
    accepted_.check(source.encoding);
    return output.emit(ros2::serialize(converted(source)), port);
  }
  const auto message = ros2::deserialize<compressed_image>(input.payload);
  const auto picture = vision::decompress(
      message, encoding_ == "mono8" ? vision::pixel_format::mono8
                                    : vision::pixel_format::bgr8);
  const auto source = vision::view(picture, message.header);
  output.emit(ros2::serialize(converted(source)), port);
}

void converter::release() {
  // Everything is given back by destructors.
}

image_view converter::converted(const image_view& source) {
  auto result = source;
  result.encoding = encoding_;
  result.is_bigendian = 0;
  if (encoding_ == "mono8") {
    const auto gray = vision::to_gray(source, pixels_);
    result.step = gray.step;
    result.data = gray.data;
    // Planes of colours lie behind those of brightness.
    result.size = std::size_t{gray.step} * gray.height;
    return result;
  }
  pixels_ = vision::to_bgr(source);
  if (encoding_ == "rgb8")
    swap_colours(pixels_);
  result.step = 3 * source.width;
  result.data = pixels_.data();
  result.size = pixels_.size();
  return result;
}

} // namespace roscell::convert
