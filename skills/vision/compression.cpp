#include "skills/vision/compression.hpp"

#include "roscell/skill/errors.hpp"

namespace roscell::vision {

namespace {

std::string format_of(const engine::parameters& options) {
  auto format = options.text("compressed_format", "jpeg");
  if (format != "jpeg" && format != "png")
    throw engine::start_error("parameter 'compressed_format' is '" + format
                              + "', but must be jpeg or png");
  return format;
}

} // namespace

compression::compression(const engine::parameters& options)
    : format_(format_of(options)),
      jpeg_quality_(
          static_cast<int>(options.count("jpeg_quality", 95, 1, 100))) {
  // nop
}

ros2::sensor_msgs::compressed_image
compression::compress(const ros2::image_view& image) const {
  auto file =
      format_ == "png" ? encode_png(image) : encode_jpeg(image, jpeg_quality_);
  auto target = image.encoding == "bgr8" ? "bgr8" : "";
  return {image.header,
          image.encoding + "; " + format_ + " compressed " + target,
          {file.begin(), file.end()}};
}

picture decompress(const ros2::sensor_msgs::compressed_image& message,
                   pixel_format wanted) {
  return decode_picture(
      {reinterpret_cast<const char*>(message.data.data()), message.data.size()},
      wanted);
}

} // namespace roscell::vision
