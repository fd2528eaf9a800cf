#include "skills/vision/brightness.hpp"

#include "roscell/skill/errors.hpp"

#include <catch2/catch.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>

using namespace roscell;
using namespace roscell::vision;

namespace {

using bytes = std::vector<std::uint8_t>;

/// Two pixels.
ros2::image_view pair_of_pixels(const std::string& encoding,
                                const bytes& pixels) {
  ros2::image_view result;
  result.width = 2;
  result.height = 1;
  result.encoding = encoding;
  result.step = static_cast<std::uint32_t>(pixels.size());
  result.data = pixels.data();
  result.size = pixels.size();
  return result;
}

} // namespace

TEST_CASE("a gray image is used where it lies") {
  bytes pixels{10, 20};
  bytes buffer;
  for (const auto* encoding : {"mono8", "8UC1"}) {
    auto gray = to_gray(pair_of_pixels(encoding, pixels), buffer);
    CHECK(gray.data == pixels.data());
    CHECK(gray.step == 2);
    CHECK(buffer.empty());
  }
}

TEST_CASE("colours become their luma in every order of channels") {
  // Red, then a gray that must stay what it is.
  bytes buffer;
  auto red_and_gray = [&](const char* encoding, const bytes& pixels) {
    auto gray = to_gray(pair_of_pixels(encoding, pixels), buffer);
    return bytes{gray.data, gray.data + 2};
  };
  CHECK(red_and_gray("rgb8", {255, 0, 0, 90, 90, 90}) == bytes{77, 90});
  CHECK(red_and_gray("bgr8", {0, 0, 255, 90, 90, 90}) == bytes{77, 90});
  CHECK(red_and_gray("8UC3", {0, 0, 255, 90, 90, 90}) == bytes{77, 90});
  CHECK(red_and_gray("rgba8", {255, 0, 0, 9, 90, 90, 90, 9}) == bytes{77, 90});
  CHECK(red_and_gray("bgra8", {0, 0, 255, 9, 90, 90, 90, 9}) == bytes{77, 90});
}

TEST_CASE("numbers of 16 bits are stretched from the darkest to the brightest, "
          "in either byte order") {
  bytes buffer;
  bytes pixels{0x00, 0x01, 0xff, 0x03}; // 256 and 1023.
  auto image = pair_of_pixels("mono16", pixels);
  auto little = to_gray(image, buffer);
  CHECK(bytes{little.data, little.data + 2} == bytes{0, 255});
  pixels = {0x03, 0xff, 0x01, 0x00};
  image = pair_of_pixels("16UC1", pixels);
  image.is_bigendian = 1;
  auto big = to_gray(image, buffer);
  CHECK(bytes{big.data, big.data + 2} == bytes{255, 0});
}

TEST_CASE("noise of a dark image of 16 bits is not spread") {
  bytes buffer;
  bytes pixels{100, 0, 103, 0};
  auto gray = to_gray(pair_of_pixels("mono16", pixels), buffer);
  CHECK(bytes{gray.data, gray.data + 2} == bytes{0, 3});
}

TEST_CASE("what is no number is black") {
  bytes buffer;
  bytes pixels(8);
  const float numbers[] = {std::nanf(""), 1};
  std::memcpy(pixels.data(), numbers, 8);
  auto gray = to_gray(pair_of_pixels("32FC1", pixels), buffer);
  CHECK(gray.data[0] == 0);
}

TEST_CASE("broken pixels do not count for the levels of an image") {
  std::vector<std::uint16_t> numbers(100 * 100);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<std::uint16_t>(i % 1000);
  numbers[5200] = 65535; // One of those by which it is judged.
  ros2::image_view image;
  image.width = 100;
  image.height = 100;
  image.encoding = "mono16";
  image.step = 200;
  image.data = reinterpret_cast<const std::uint8_t*>(numbers.data());
  image.size = 20'000;
  bytes buffer;
  auto gray = to_gray(image, buffer);
  CHECK(gray.data[500] == Approx(127).margin(1));
}

TEST_CASE("an unknown encoding is an error that names it") {
  bytes pixels{1, 2};
  bytes buffer;
  CHECK_THROWS_AS(to_gray(pair_of_pixels("odd", pixels), buffer),
                  engine::unusable_input);
  CHECK_THROWS_WITH(to_gray(pair_of_pixels("odd", pixels), buffer),
                    Catch::Matchers::Contains("'odd'"));
}

namespace {

/// An image of noise, and what OpenCV makes of it.
void check_like_opencv(const std::string& encoding, int channels, int rows,
                       int code, int margin) {
  CAPTURE(encoding);
  constexpr auto width = 64;
  constexpr auto height = 48;
  cv::Mat noise(rows, width, CV_8UC(channels));
  cv::RNG random{7};
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::Mat expected;
  cv::cvtColor(noise, expected, code);
  ros2::image_view image;
  image.width = width;
  image.height = height;
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(width * channels);
  image.data = noise.data;
  image.size = noise.total() * noise.elemSize();
  const auto found = to_bgr(image);
  auto off = 0;
  // At its border OpenCV repeats a mosaic's colours of the rows inside.
  for (auto y = 1; y < height - 1; ++y)
    for (auto x = 1; x < width - 1; ++x)
      for (auto c = 0; c < 3; ++c)
        off = std::max(
            off,
            std::abs(found[static_cast<std::size_t>(3 * (y * width + x) + c)]
                     - expected.at<cv::Vec3b>(y, x)[c]));
  CHECK(off <= margin);
}

} // namespace

TEST_CASE("colours are those that OpenCV makes of YUV and Bayer") {
  check_like_opencv("yuv422_yuy2", 2, 48, cv::COLOR_YUV2BGR_YUY2, 2);
  check_like_opencv("uyvy", 2, 48, cv::COLOR_YUV2BGR_UYVY, 2);
  check_like_opencv("nv12", 1, 72, cv::COLOR_YUV2BGR_NV12, 2);
  check_like_opencv("nv21", 1, 72, cv::COLOR_YUV2BGR_NV21, 2);
  check_like_opencv("i420", 1, 72, cv::COLOR_YUV2BGR_I420, 2);
  check_like_opencv("bayer_rggb8", 1, 48, cv::COLOR_BayerBG2BGR, 1);
  check_like_opencv("bayer_bggr8", 1, 48, cv::COLOR_BayerRG2BGR, 1);
  check_like_opencv("bayer_gbrg8", 1, 48, cv::COLOR_BayerGR2BGR, 1);
  check_like_opencv("bayer_grbg8", 1, 48, cv::COLOR_BayerGB2BGR, 1);
}

TEST_CASE("a picture to draw on has three bytes per pixel") {
  CHECK(to_bgr(pair_of_pixels("mono8", {7, 8})) == bytes{7, 7, 7, 8, 8, 8});
  CHECK(to_bgr(pair_of_pixels("rgb8", {1, 2, 3, 4, 5, 6}))
        == bytes{3, 2, 1, 6, 5, 4});
}
