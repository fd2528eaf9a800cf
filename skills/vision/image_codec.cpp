#include "skills/vision/image_codec.hpp"

#include "roscell/skill/errors.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <memory>

namespace roscell::vision {

namespace {

constexpr std::string_view png_signature{"\x89PNG\r\n\x1a\n", 8};
constexpr std::string_view jpeg_signature{"\xff\xd8\xff", 3};

struct png_closer {
  void operator()(png_image* image) const {
    png_image_free(image);
  }
};

struct jpeg_closer {
  void operator()(void* codec) const {
    tjDestroy(codec);
  }
};

bool begins_with(std::string_view bytes, std::string_view signature) {
  return bytes.substr(0, signature.size()) == signature;
}

picture make_picture(std::uint64_t width, std::uint64_t height,
                     pixel_format format) {
  if (width * height > max_picture_pixels)
    throw image_error("it has " + std::to_string(width) + " x "
                      + std::to_string(height) + " pixels, more than "
                      + std::to_string(max_picture_pixels));
  picture result;
  result.width = static_cast<std::uint32_t>(width);
  result.height = static_cast<std::uint32_t>(height);
  result.format = format;
  result.pixels.resize(result.step() * result.height);
  return result;
}

/// By libpng's simplified interface, which needs no longjmp.
picture decode_png(std::string_view file, pixel_format wanted) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  std::unique_ptr<png_image, png_closer> closer{&header};
  if (png_image_begin_read_from_memory(&header, file.data(), file.size()) == 0)
    throw image_error(std::string{"broken PNG: "} + header.message);
  header.format =
      wanted == pixel_format::mono8 ? PNG_FORMAT_GRAY : PNG_FORMAT_BGR;
  auto result = make_picture(header.width, header.height, wanted);
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&header, &white, result.pixels.data(), 0, nullptr)
      == 0)
    throw image_error(std::string{"broken PNG: "} + header.message);
  return result;
}

picture decode_jpeg(std::string_view file, pixel_format wanted) {
  std::unique_ptr<void, jpeg_closer> decoder{tjInitDecompress()};
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  auto size = static_cast<unsigned long>(file.size());
  auto check = [&](int status) {
    if (status != 0)
      throw image_error(std::string{"broken JPEG: "}
                        + tjGetErrorStr2(decoder.get()));
  };
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colours = 0;
  check(tjDecompressHeader3(decoder.get(), bytes, size, &width, &height,
                            &subsampling, &colours));
  auto result = make_picture(static_cast<std::uint64_t>(width),
                             static_cast<std::uint64_t>(height), wanted);
  // A progressive file of a few bytes may ask for hours of work.
  constexpr auto flags = TJFLAG_LIMITSCANS;
  check(tjDecompress2(
      decoder.get(), bytes, size, result.pixels.data(), width, 0, height,
      wanted == pixel_format::mono8 ? TJPF_GRAY : TJPF_BGR, flags));
  return result;
}

/// Throws image_error when it is neither gray nor coloured as a picture is.
bool is_gray(const ros2::image_view& source) {
  if (source.encoding != "mono8" && source.encoding != "bgr8")
    throw image_error("images in encoding '" + source.encoding
                      + "' cannot be compressed; mono8 and bgr8 can");
  return source.encoding == "mono8";
}

} // namespace

const char* encoding_name(pixel_format format) {
  return format == pixel_format::mono8 ? "mono8" : "bgr8";
}

ros2::image_view view(const picture& source, ros2::std_msgs::header header) {
  return {std::move(header),
          source.height,
          source.width,
          encoding_name(source.format),
          0,
          static_cast<std::uint32_t>(source.step()),
          source.pixels.data(),
          source.pixels.size()};
}

picture decode_picture(std::string_view file, pixel_format wanted) {
  if (begins_with(file, png_signature))
    return decode_png(file, wanted);
  if (begins_with(file, jpeg_signature))
    return decode_jpeg(file, wanted);
  throw image_error("it is neither PNG nor JPEG");
}

std::string encode_png(const ros2::image_view& source) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = source.width;
  header.height = source.height;
  header.format = is_gray(source) ? PNG_FORMAT_GRAY : PNG_FORMAT_BGR;
  header.flags = PNG_IMAGE_FLAG_FAST;
  auto size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string result(size, '\0');
  if (png_image_write_to_memory(&header, result.data(), &size, 0, source.data,
                                static_cast<png_int_32>(source.step), nullptr)
      == 0)
    throw image_error(std::string{"cannot write PNG: "} + header.message);
  result.resize(size);
  return result;
}

std::string encode_jpeg(const ros2::image_view& source, int quality) {
  const auto gray = is_gray(source);
  const auto width = static_cast<int>(source.width);
  const auto height = static_cast<int>(source.height);
  const auto subsampling = gray ? TJSAMP_GRAY : TJSAMP_420;
  std::unique_ptr<void, jpeg_closer> encoder{tjInitCompress()};
  auto size = tjBufSize(width, height, subsampling);
  if (width <= 0 || height <= 0 || size == static_cast<unsigned long>(-1))
    throw image_error("cannot write JPEG: " + std::to_string(source.width)
                      + " x " + std::to_string(source.height)
                      + " pixels are no picture");
  std::string result(size, '\0');
  auto* target = reinterpret_cast<unsigned char*>(result.data());
  if (tjCompress2(encoder.get(), source.data, width,
                  static_cast<int>(source.step), height,
                  gray ? TJPF_GRAY : TJPF_BGR, &target, &size, subsampling,
                  quality, TJFLAG_NOREALLOC)
      != 0)
    throw image_error(std::string{"cannot write JPEG: "}
                      + tjGetErrorStr2(encoder.get()));
  result.resize(size);
  return result;
}

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
