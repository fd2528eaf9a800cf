#include "roscell/ros2/image_view.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"

#include "bytes.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

const std::vector<std::uint8_t> pixels{1, 2, 3, 4, 5, 6, 7, 8};

/// Two rows of one rgb8 pixel and one byte of padding.
ros2::image_view small_image() {
  return {{{1, 2}, "cam"}, 2, 1, "rgb8", 0, 4, pixels.data(), pixels.size()};
}

/// The error of reading an image of which one number was changed after it was
/// written: the byte `from_end` before the pixels' first one.
std::string error_with(std::size_t from_end, char value) {
  auto payload = ros2::serialize(small_image());
  payload[payload.size() - pixels.size() - from_end] = value;
  try {
    ros2::view_image(payload);
    return "none";
  } catch (const ros2::cdr_error& e) {
    return e.what();
  }
}

} // namespace

TEST_CASE("an image view points into the payload") {
  auto payload = ros2::serialize(small_image());
  auto x = ros2::view_image(payload);
  CHECK(x.header == ros2::std_msgs::header{{1, 2}, "cam"});
  CHECK(x.height == 2);
  CHECK(x.width == 1);
  CHECK(x.encoding == "rgb8");
  CHECK(x.step == 4);
  REQUIRE(x.size == pixels.size());
  CHECK(std::equal(pixels.begin(), pixels.end(), x.data));
  CHECK(reinterpret_cast<const char*>(x.data) + x.size
        == payload.data() + payload.size());
}

TEST_CASE("an image whose sizes lie is refused") {
  constexpr std::size_t count = 4;
  constexpr std::size_t step = 8;
  constexpr std::size_t width = 8 + 8 + 4 + 4; // Padding, order, encoding.
  constexpr std::size_t height = width + 4;
  CHECK(error_with(step, 4) == "none");
  CHECK(error_with(step, 2)
        == "field 'data': 8 bytes are not 2 rows of 2 bytes");
  CHECK(error_with(height, 3)
        == "field 'data': 8 bytes are not 3 rows of 4 bytes");
  CHECK(error_with(width, 2)
        == "field 'step': 4 bytes are too few for 2 pixels of rgb8");
  CHECK(error_with(count, 9)
        == "field 'data': its length 9 is too much for the 8 bytes that are "
           "left");
  CHECK(error_with(count, 4)
        == "field '': 4 bytes are left behind the last field");
}

TEST_CASE("sizes that overflow 32 bits are no way around the check") {
  auto x = small_image();
  x.height = 0x80000000;
  x.step = 2;
  x.size = 0; // What 32 bits would make of it.
  CHECK_THROWS_AS(ros2::serialize(x), ros2::cdr_error);
  x = small_image();
  x.width = 0x55555556;
  CHECK_THROWS_AS(ros2::serialize(x), ros2::cdr_error);
}

TEST_CASE("an image without pixels is an image") {
  auto payload = ros2::serialize(ros2::sensor_msgs::image{});
  CHECK(ros2::view_image(payload).size == 0);
}

TEST_CASE("rows of colours follow those of pixels, counted among them or not") {
  const auto height_of = [](const char* encoding, std::uint32_t height,
                            std::size_t bytes) {
    const std::vector<std::uint8_t> data(bytes);
    ros2::sensor_msgs::image sent;
    sent.height = height;
    sent.width = 4;
    sent.encoding = encoding;
    sent.step = 4;
    sent.data = data;
    const auto payload = ros2::serialize(sent);
    try {
      return static_cast<int>(ros2::view_image(payload).height);
    } catch (const ros2::cdr_error&) {
      return -1;
    }
  };
  for (const char* encoding : {"nv12", "nv21", "i420"}) {
    CHECK(height_of(encoding, 4, 24) == 4);
    CHECK(height_of(encoding, 6, 24) == 4);
    CHECK(height_of(encoding, 3, 20) == 3);
    CHECK(height_of(encoding, 4, 16) == -1);
    CHECK(height_of(encoding, 5, 20) == -1);
  }
  CHECK(height_of("nv24", 4, 48) == 4);
  CHECK(height_of("nv24", 12, 48) == 4);
  CHECK(height_of("nv24", 4, 24) == -1);
  CHECK(height_of("mono8", 4, 24) == -1);
}

TEST_CASE("the encodings of ROS 2 and OpenCV have the pixels they say") {
  using ros2::bytes_per_pixel;
  CHECK(bytes_per_pixel("mono8") == 1U);
  CHECK(bytes_per_pixel("bgr8") == 3U);
  CHECK(bytes_per_pixel("rgba16") == 8U);
  CHECK(bytes_per_pixel("bayer_grbg16") == 2U);
  CHECK(bytes_per_pixel("8UC3") == 3U);
  CHECK(bytes_per_pixel("32FC1") == 4U);
  CHECK(bytes_per_pixel("64FC9") == 72U);
  CHECK(bytes_per_pixel("16U") == 2U);
  CHECK(bytes_per_pixel("uyvy") == 2U);
  CHECK(bytes_per_pixel("nv12") == 1U);
  CHECK(bytes_per_pixel("NV12") == 1U);
  for (const char* name : {"", "mono", "8UC", "8UC0", "8UC11", "8UX3", "nv99"})
    CHECK_FALSE(bytes_per_pixel(name));
}
