#include "skills/pose_estimation/gray_image.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>

using namespace roscell;
using namespace roscell::pose;

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

TEST_CASE("of 16 bits the upper ones count, in either byte order") {
  bytes buffer;
  bytes pixels{1, 2, 3, 4};
  auto image = pair_of_pixels("mono16", pixels);
  auto little = to_gray(image, buffer);
  CHECK(bytes{little.data, little.data + 2} == bytes{2, 4});
  image.is_bigendian = 1;
  auto big = to_gray(image, buffer);
  CHECK(bytes{big.data, big.data + 2} == bytes{1, 3});
}

TEST_CASE("an unknown encoding is an error that names it") {
  bytes pixels{1, 2};
  bytes buffer;
  CHECK_THROWS_WITH(to_gray(pair_of_pixels("bayer_rggb8", pixels), buffer),
                    Catch::Matchers::Contains("bayer_rggb8"));
}

TEST_CASE("a picture to draw on has three bytes per pixel") {
  CHECK(to_bgr(pair_of_pixels("mono8", {7, 8})) == bytes{7, 7, 7, 8, 8, 8});
  CHECK(to_bgr(pair_of_pixels("rgb8", {1, 2, 3, 4, 5, 6}))
        == bytes{3, 2, 1, 6, 5, 4});
}
