#include "roscell/skill/errors.hpp"
#include "skills/video/video_input.hpp"
#include "skills/video/video_protocol.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <opencv2/videoio.hpp>

using namespace roscell;
using namespace roscell::test;
using namespace roscell::video;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

/// Gives a number of gray pictures, the n-th one of brightness n.
class short_video : public picture_reader {
public:
  explicit short_video(int pictures) : pictures_(pictures) {
    // nop
  }

  bool read(cv::Mat& target) override {
    if (next_ >= pictures_)
      return false;
    target = cv::Mat(2, 3, CV_8UC3, cv::Scalar::all(next_++));
    return true;
  }

private:
  const int pictures_;
  int next_ = 0;
};

open_reader video_of(int pictures) {
  return [=](const std::string&) {
    return std::make_unique<short_video>(pictures);
  };
}

/// Takes so many frames, then stops the input.
class limited_sink : public engine::frame_sink {
public:
  explicit limited_sink(std::size_t limit = 1000) : limit_(limit) {
    // nop
  }

  bool push(engine::frame input, engine::when_full policy) override {
    if (frames.size() >= limit_)
      return false;
    frames.push_back(std::move(input));
    policies.push_back(policy);
    return true;
  }

  std::vector<engine::frame> frames;
  std::vector<engine::when_full> policies;

private:
  const std::size_t limit_;
};

engine::stream_context context(const std::string& endpoint,
                               const json& options) {
  return {{"video", endpoint, image_type},
          parameters_of(options),
          [](const std::string&) {}};
}

/// Runs an input to its end; returns "ended", or what it threw.
std::string run(limited_sink& sink, const std::string& endpoint,
                const open_reader& open, const json& options = json::object()) {
  engine::stop_event stop;
  try {
    video_input input{context(endpoint, options), open};
    input.open();
    input.run(sink, stop);
    return "ended";
  } catch (const engine::stream_error& e) {
    return std::string{"stream_error: "} + e.what();
  } catch (const engine::start_error& e) {
    return std::string{"start_error: "} + e.what();
  }
}

/// A film of three frames.
void write_film(const std::string& path) {
  cv::VideoWriter film{
      path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {64, 48}};
  for (auto i = 0; i < 3; ++i)
    film.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(50 * i)));
}

} // namespace

TEST_CASE("each picture of a video file is an image message") {
  limited_sink sink;
  CHECK(run(sink, "/film.avi", video_of(3), {{"frame_id", "eye"}}) == "ended");
  REQUIRE(sink.frames.size() == 3);
  CHECK(sink.policies[0] == engine::when_full::wait);
  CHECK(sink.frames[2].data_type == image_type);
  CHECK(sink.frames[2].name == "2");
  auto image =
      ros2::deserialize<ros2::sensor_msgs::image>(sink.frames[2].payload);
  CHECK(image.encoding == "mono8");
  CHECK(image.width == 3);
  CHECK(image.height == 2);
  CHECK(image.header.frame_id == "eye");
  CHECK(image.data == std::vector<std::uint8_t>(6, 2));
}

TEST_CASE("pictures may stay coloured") {
  limited_sink sink;
  CHECK(run(sink, "/film.avi", video_of(1), {{"encoding", "bgr8"}}) == "ended");
  auto image =
      ros2::deserialize<ros2::sensor_msgs::image>(sink.frames[0].payload);
  CHECK(image.encoding == "bgr8");
  CHECK(image.step == 9);
}

TEST_CASE("a video file in a loop begins again") {
  limited_sink sink{8};
  CHECK(run(sink, "/film.avi", video_of(3), {{"loop", true}}) == "ended");
  CHECK(sink.frames.size() == 8);
  CHECK(sink.frames[7].name == "7");
}

TEST_CASE("a camera that vanishes breaks the input, by its name") {
  limited_sink sink;
  auto outcome = run(sink, "/dev/video7", video_of(2), {{"loop", true}});
  CHECK_THAT(outcome, Contains("stream_error: camera '/dev/video7' gives no"));
  CHECK(sink.frames.size() == 2);
  CHECK(sink.policies[0] == engine::when_full::drop_oldest);
}

TEST_CASE("a camera that is faster than its rate loses pictures, not time") {
  limited_sink sink;
  run(sink, "/dev/video7", video_of(100), {{"rate_hz", 0.001}});
  CHECK(sink.frames.size() == 1);
}

TEST_CASE("a file without a picture breaks the input also in a loop") {
  limited_sink sink;
  CHECK_THAT(run(sink, "/film.avi", video_of(0), {{"loop", true}}),
             Contains("stream_error: video file '/film.avi' holds no picture"));
}

TEST_CASE("a video that cannot be opened does not start") {
  limited_sink sink;
  auto nothing = [](const std::string&) {
    return std::unique_ptr<picture_reader>{};
  };
  CHECK_THAT(run(sink, "/dev/video7", nothing),
             Contains("start_error: cannot open camera '/dev/video7'"));
  CHECK_THAT(run(sink, "film.avi", nothing),
             Contains("start_error") && Contains("absolute"));
  CHECK_THAT(run(sink, "/film.avi", nothing, {{"encoding", "yuv"}}),
             Contains("start_error") && Contains("yuv"));
}

TEST_CASE("a real film is read by OpenCV") {
  temp_folder folder;
  write_film(folder / "film.avi");
  limited_sink sink;
  CHECK(run(sink, folder / "film.avi", make_capture) == "ended");
  REQUIRE(sink.frames.size() == 3);
  auto image =
      ros2::deserialize<ros2::sensor_msgs::image>(sink.frames[2].payload);
  CHECK(image.width == 64);
  CHECK(image.data[0] == Approx(100).margin(3));
}

TEST_CASE("OpenCV opens no film that is none") {
  temp_folder folder{"film.avi", "no film"};
  CHECK(make_capture(folder / "film.avi") == nullptr);
  CHECK(make_capture(folder / "none.avi") == nullptr);
  CHECK(make_capture("/dev/video77") == nullptr);
}
