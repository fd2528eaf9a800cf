#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::vision;
using Catch::Matchers::Contains;

namespace {

picture stripes(pixel_format format) {
  picture result;
  result.width = 5;
  result.height = 3;
  result.format = format;
  for (std::size_t i = 0; i < result.step() * result.height; ++i)
    result.pixels.push_back(static_cast<std::uint8_t>(i * 5));
  return result;
}

std::string error_of(const std::string& file) {
  try {
    decode_picture(file, pixel_format::mono8);
  } catch (const image_error& e) {
    return e.what();
  }
  return "none";
}

/// A PNG whose header promises 100000 x 100000 pixels, and its first data.
const std::string huge_png{"\x89PNG\r\n\x1a\n"
                           "\0\0\0\rIHDR\0\1\x86\xa0\0\1\x86\xa0\x08\0\0\0\0"
                           "\x8d\x39\x54\x14"
                           "\0\0\0\0IDAT\x35\xaf\x06\x1e",
                           45};

} // namespace

TEST_CASE("what is written as PNG is read back, gray or coloured") {
  auto format = GENERATE(pixel_format::mono8, pixel_format::bgr8);
  auto written = stripes(format);
  auto read = decode_picture(encode_png(written), format);
  CHECK(read.width == 5);
  CHECK(read.height == 3);
  CHECK(read.format == format);
  CHECK(read.pixels == written.pixels);
}

TEST_CASE("a JPEG is read gray or coloured") {
  auto file = test::content_of(test::photo);
  auto gray = decode_picture(file, pixel_format::mono8);
  auto colour = decode_picture(file, pixel_format::bgr8);
  CHECK(gray.width == 799);
  CHECK(gray.height == 533);
  CHECK(gray.pixels.size() == 799 * 533);
  CHECK(colour.pixels.size() == 3 * 799 * 533);
}

TEST_CASE("what is written as JPEG is nearly the same when it is read back") {
  auto format = GENERATE(pixel_format::mono8, pixel_format::bgr8);
  // Smooth, as JPEG has it.
  picture written{64, 48, format, {}};
  for (std::size_t i = 0; i < written.step() * written.height; ++i)
    written.pixels.push_back(
        static_cast<std::uint8_t>(i / written.step() * 4 + 20));
  auto most_difference = [&](int quality) {
    auto read = decode_picture(encode_jpeg(view(written, {}), quality), format);
    REQUIRE(read.pixels.size() == written.pixels.size());
    auto result = 0;
    for (std::size_t i = 0; i < read.pixels.size(); ++i)
      result = std::max(result, std::abs(read.pixels[i] - written.pixels[i]));
    return result;
  };
  CHECK(most_difference(95) <= 2);
  CHECK(most_difference(5) > 2);
}

TEST_CASE("rows with gaps between them are compressed without the gaps") {
  auto written = stripes(pixel_format::mono8);
  std::vector<std::uint8_t> spaced;
  for (std::size_t y = 0; y < written.height; ++y) {
    auto row = written.pixels.begin() + static_cast<std::ptrdiff_t>(y * 5);
    spaced.insert(spaced.end(), row, row + 5);
    spaced.insert(spaced.end(), 3, 255);
  }
  ros2::image_view image{{}, 3, 5, "mono8", 0, 8, spaced.data(), spaced.size()};
  CHECK(decode_picture(encode_png(image), pixel_format::mono8).pixels
        == written.pixels);
  CHECK(encode_jpeg(image, 90) == encode_jpeg(view(written, {}), 90));
}

TEST_CASE("what is neither gray nor blue, green and red is not compressed") {
  std::vector<std::uint8_t> pixel(3);
  ros2::image_view image{{}, 1, 1, "rgb8", 0, 3, pixel.data(), pixel.size()};
  CHECK_THROWS_WITH(encode_png(image), Contains("'rgb8'"));
  CHECK_THROWS_WITH(encode_jpeg(image, 90), Contains("'rgb8'"));
  CHECK_THROWS_AS(encode_jpeg({{}, 0, 0, "mono8", 0, 0, nullptr, 0}, 90),
                  image_error);
}

TEST_CASE("a broken picture is an error that says what is wrong") {
  auto png = encode_png(stripes(pixel_format::mono8));
  auto jpeg = test::content_of(test::photo);
  CHECK_THAT(error_of(png.substr(0, png.size() / 2)), Contains("broken PNG"));
  CHECK_THAT(error_of(jpeg.substr(0, 5000)), Contains("broken JPEG"));
  CHECK_THAT(error_of(jpeg.substr(0, 50)), Contains("broken JPEG"));
  CHECK(error_of("hello") == "it is neither PNG nor JPEG");
  CHECK(error_of("") == "it is neither PNG nor JPEG");
}

TEST_CASE("a few bytes that promise too many pixels take no memory") {
  CHECK_THAT(error_of(huge_png), Contains("100000 x 100000 pixels"));
}
