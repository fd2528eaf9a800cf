#include "roscell/skill/errors.hpp"
#include "skills/image_source/image_source.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;
using source::image_source;
using strings = std::vector<std::string>;

namespace {

vision::picture small_picture() {
  return {4, 2, vision::pixel_format::mono8, {1, 2, 3, 4, 5, 6, 7, 8}};
}

struct bench {
  bench(const strings& inputs, const strings& outputs, const json& options)
      : source(make_environment(inputs, outputs, options), said.function()) {
    // nop
  }

  void show(std::size_t port, const std::string& file,
            const std::string& name = "a.png") {
    source.process(make_frame(port, picture_type, file, name), out);
  }

  ros2::sensor_msgs::image image(std::size_t port, std::size_t n = 0) {
    return ros2::deserialize<ros2::sensor_msgs::image>(
        out.of(port).at(n).payload);
  }

  ros2::sensor_msgs::camera_info info(std::size_t port, std::size_t n = 0) {
    return ros2::deserialize<ros2::sensor_msgs::camera_info>(
        out.of(port).at(n).payload);
  }

  ros2::sensor_msgs::compressed_image compressed(std::size_t port) {
    return ros2::deserialize<ros2::sensor_msgs::compressed_image>(
        out.of(port).at(0).payload);
  }

  said_lines said;
  collecting_emitter out;
  image_source source;
};

} // namespace

TEST_CASE("a picture becomes an image and its camera's description") {
  bench b{{picture_type},
          {info_type, image_type},
          {{"frame_id", "left"}, {"fx", 5}, {"fy", 5}, {"cx", 2}, {"cy", 1}}};
  b.show(0, vision::encode_png(small_picture()));
  auto image = b.image(1);
  auto info = b.info(0);
  CHECK(image.width == 4);
  CHECK(image.height == 2);
  CHECK(image.encoding == "mono8");
  CHECK(image.step == 4);
  CHECK(image.data == small_picture().pixels);
  CHECK(image.header.frame_id == "left");
  CHECK(image.header == info.header);
  CHECK(image.header.stamp.sec > 1'000'000'000);
  CHECK(info.width == 4);
  CHECK(info.height == 2);
  CHECK(info.k[0] == 5);
  CHECK(b.out.of(0)[0].time == b.out.of(1)[0].time);
}

TEST_CASE("images may be coloured") {
  bench b{{picture_type}, {image_type}, {{"encoding", "bgr8"}}};
  b.show(0, vision::encode_png(small_picture()));
  CHECK(b.image(0).encoding == "bgr8");
  CHECK(b.image(0).step == 12);
  CHECK(b.image(0).data.size() == 24);
}

TEST_CASE("images may be compressed, beside others or alone") {
  auto [options, format, first_bytes] = GENERATE(
      std::tuple{json{{"encoding", "bgr8"}}, "bgr8; jpeg compressed bgr8",
                 std::string{"\xff\xd8"}},
      std::tuple{json{{"compressed_format", "png"}}, "mono8; png compressed ",
                 std::string{"\x89PNG"}});
  bench b{{picture_type}, {compressed_type, image_type, info_type}, options};
  b.show(0, vision::encode_png(small_picture()));
  auto message = b.compressed(0);
  CHECK(message.format == format);
  CHECK(message.header == b.image(1).header);
  CHECK(message.header == b.info(2).header);
  std::string file{message.data.begin(), message.data.end()};
  CHECK(file.substr(0, first_bytes.size()) == first_bytes);
  auto read = vision::decode_picture(file, vision::pixel_format::mono8);
  CHECK(read.width == 4);
  CHECK(read.height == 2);
  if (message.format[0] == 'm')
    CHECK(read.pixels == small_picture().pixels);
}

TEST_CASE("an image that a video gave is compressed with its stamp") {
  bench b{{image_type}, {compressed_type}, {{"compressed_format", "png"}}};
  auto picture = small_picture();
  auto message = ros2::serialize(vision::view(picture, {{12, 34}, "eye"}));
  b.source.process(make_frame(0, image_type, message), b.out);
  CHECK(b.compressed(0).header == ros2::std_msgs::header{{12, 34}, "eye"});
}

TEST_CASE("a camera that is not calibrated has intrinsics of zero") {
  bench b{{picture_type}, {image_type, info_type}, json::object()};
  b.show(0, vision::encode_png(small_picture()));
  CHECK(b.info(1).width == 4);
  CHECK(b.info(1).k == std::array<double, 9>{});
}

TEST_CASE("pictures of another size than the calibration are said once") {
  temp_folder folder{"camera.json", R"({"image_width": 8, "image_height": 6,
    "camera_matrix": {"data": [5, 0, 4, 0, 5, 3, 0, 0, 1]}})"};
  bench b{
      {picture_type}, {info_type}, {{"camera_file", folder / "camera.json"}}};
  b.show(0, vision::encode_png(small_picture()));
  b.show(0, vision::encode_png(small_picture()));
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("4 x 2") && Contains("8 x 6"));
  CHECK(b.info(0).width == 8);
}

TEST_CASE("a broken picture of a folder in a loop is said once") {
  bench b{{picture_type}, {image_type}, json::object()};
  for (auto i = 0; i < 3; ++i) {
    b.show(0, "no picture", "broken.png");
    b.show(0, vision::encode_png(small_picture()));
  }
  CHECK(b.out.of(0).size() == 3);
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("'broken.png'"));
}

TEST_CASE("several folders feed their own topics") {
  bench b{{picture_type, picture_type},
          {image_type, image_type, info_type, info_type},
          json::object()};
  b.show(1, vision::encode_png(small_picture()));
  CHECK(b.out.of(0).empty());
  CHECK(b.out.of(1).size() == 1);
  CHECK(b.out.of(2).empty());
  CHECK(b.out.of(3).size() == 1);
}

TEST_CASE("an image that a video gave is passed on with its stamp") {
  bench b{{image_type}, {image_type, info_type}, json::object()};
  auto picture = small_picture();
  auto message = ros2::serialize(vision::view(picture, {{12, 34}, "eye"}));
  b.source.process(make_frame(0, image_type, message), b.out);
  CHECK(b.out.of(0)[0].payload == message);
  CHECK(b.info(1).header.stamp == ros2::builtin_interfaces::time{12, 34});
  CHECK(b.info(1).header.frame_id == "eye");
}

TEST_CASE("an image source that makes no sense does not start") {
  auto error_of = [](const strings& outputs, const json& options) {
    try {
      bench{{picture_type}, outputs, options};
    } catch (const engine::start_error& e) {
      return std::string{e.what()};
    }
    return std::string{"none"};
  };
  CHECK_THAT(error_of({"text/plain"}, json::object()), Contains("text/plain"));
  CHECK_THAT(error_of({image_type}, {{"encoding", "yuv"}}), Contains("yuv"));
  CHECK_THAT(error_of({compressed_type}, {{"compressed_format", "gif"}}),
             Contains("gif"));
  CHECK_THAT(error_of({compressed_type}, {{"jpeg_quality", 0}}),
             Contains("jpeg_quality"));
  CHECK_THAT(error_of({image_type}, {{"fx", 1}}), Contains("belong together"));
}
