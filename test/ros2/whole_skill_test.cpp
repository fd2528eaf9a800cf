#include "cell_fixture.hpp"

#include "actors/edge/process/notify_socket.hpp"
#include "roscell/ros2.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "skills/engine/primitive_base_engine.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr const char* image = ros2::sensor_msgs::image::type_name;

/// Says how large an image is.
class size_reporter : public engine::executor {
public:
  void process(const engine::frame& input, engine::emitter& output) override {
    auto x = ros2::view_image(input.payload);
    output.emit(ros2::serialize(ros2::std_msgs::string{
        std::to_string(x.width) + "x" + std::to_string(x.height)}));
  }

  void release() override {
    // Nothing is held.
  }
};

/// A skill from image to text, as a node of `home` starts it.
class running_skill {
public:
  explicit running_skill(const cell& home, const std::string& socket = {}) {
    const auto lookup = lookup_in(home.environment("teller"));
    ros2::add_ros2_protocol(parts_, lookup);
    parts_.add_executor<size_reporter>("teller");
    env_.model = "teller";
    env_.notify_socket = socket;
    env_.inputs = {{"ros2", "/image", image}};
    env_.outputs = {{"ros2", "/size", text}};
    engine_.emplace(parts_, env_, log.say());
    thread_ = std::thread{[this] { code_ = engine_->run(); }};
  }

  ~running_skill() {
    stop();
  }

  engine::exit_code stop() {
    engine_->request_stop();
    if (thread_.joinable())
      thread_.join();
    return code_;
  }

  logbook log;

private:
  engine::registry parts_;
  engine::environment env_;
  std::optional<engine::primitive_base_engine> engine_;
  engine::exit_code code_{};
  std::thread thread_;
};

std::string gray_image(std::uint32_t height, std::uint32_t width) {
  std::vector<std::uint8_t> pixels(std::size_t{height} * width);
  return ros2::serialize(
      ros2::sensor_msgs::image{{}, height, width, "mono8", 0, width, pixels});
}

} // namespace

TEST_CASE("a skill goes on after an image whose sizes lie") {
  cell home{0};
  skill camera{home.environment("camera")};
  skill reader{home.environment("reader")};
  running_skill reporter{home};
  running_input sizes{reader.input("/size", text)};
  auto images = camera.output("/image", image);
  REQUIRE(camera.log.wait_for("a reader has come"));
  REQUIRE(reporter.log.wait_for("'/image': a writer has come"));
  REQUIRE(reporter.log.wait_for("'/size': a reader has come"));
  auto lie = gray_image(2, 3);
  lie[24] = 7; // Its width, behind a header without a name.
  images->write(frame_of(image, lie));
  images->write(frame_of(image, gray_image(2, 3)));
  CHECK(text_of(sizes.sink().wait_for(0)) == "3x2");
  CHECK(reporter.log.wait_for("frame 'image-1' failed (1 in a row): field "
                              "'step': 3 bytes are too few for 7 pixels"));
  CHECK(reporter.stop() == engine::exit_code::done);
}

TEST_CASE("a skill goes on in another place when its node tells it so") {
  cell home{0};
  cell other{1};
  temp_folder folder;
  notify_receiver node{folder / "notify"};
  const auto reported = environment_file_of(folder / "notify");
  make_environment_file(reported);
  running_skill reporter{home, folder / "notify"};
  REQUIRE(node.wait_for("READY=1"));
  skill far_camera{other.environment("camera")};
  skill far_reader{other.environment("reader")};
  running_input sizes{far_reader.input("/size", text)};
  auto images = far_camera.output("/image", image);
  // A second time before the first is done, and while messages come.
  REQUIRE(write_environment_update(reported, home.environment("teller")));
  REQUIRE(write_environment_update(reported, other.environment("teller")));
  REQUIRE(far_camera.log.wait_for("a reader has come"));
  REQUIRE(reporter.log.wait_for("'/image': a writer has come"));
  REQUIRE(reporter.log.wait_for("'/size': a reader has come"));
  images->write(frame_of(image, gray_image(2, 3)));
  REQUIRE(sizes.sink().wait_for(0));
  REQUIRE(write_environment_update(reported, other.environment("teller")));
  REQUIRE(far_camera.log.wait_for("a reader has come", 2));
  REQUIRE(reporter.log.wait_for("'/size': a reader has come", 2));
  images->write(frame_of(image, gray_image(4, 5)));
  CHECK(text_of(sizes.sink().wait_for(1)) == "5x4");
  CHECK(reporter.stop() == engine::exit_code::done);
  CHECK_FALSE(write_environment_update(reported, home.environment("teller")));
}

TEST_CASE("a skill moves time and again while images come") {
  cell home{0};
  temp_folder folder;
  notify_receiver node{folder / "notify"};
  const auto reported = environment_file_of(folder / "notify");
  make_environment_file(reported);
  running_skill reporter{home, folder / "notify"};
  REQUIRE(node.wait_for("READY=1"));
  skill camera{home.environment("camera")};
  auto images = camera.output("/image", image);
  for (std::ptrdiff_t move = 1; move <= 5; ++move) {
    REQUIRE(camera.log.wait_for("a reader has come", move));
    for (int i = 0; i < 20; ++i)
      images->write(frame_of(image, gray_image(2, 3)));
    REQUIRE(write_environment_update(reported, home.environment("teller")));
    for (int i = 0; i < 20; ++i)
      images->write(frame_of(image, gray_image(2, 3)));
  }
  REQUIRE(reporter.log.wait_for("made anew in", 5));
  CHECK(reporter.stop() == engine::exit_code::done);
}
