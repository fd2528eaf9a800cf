#include "skills/vision/paired_executor.hpp"

#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/rectify/rectifier.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;
using vision::stamped_calibrations;

namespace {

stamped_calibrations::stamp at_s(int seconds) {
  return stamped_calibrations::stamp{std::chrono::seconds{seconds}};
}

ros2::sensor_msgs::camera_info numbered(std::uint32_t width) {
  ros2::sensor_msgs::camera_info result;
  result.width = width;
  return result;
}

engine::frame stamped(std::size_t port, const std::string& type,
                      std::string payload, int seconds) {
  auto result = make_frame(port, type, std::move(payload));
  result.time = at_s(seconds);
  return result;
}

/// A camera whose zoom changes: the same picture with another focal length.
template <class Executor>
struct bench {
  explicit bench(const std::string& output,
                 const json& options = json::object())
      : skill(make_environment({image_type, info_type}, {output}, options),
              said.function()) {
    // nop
  }

  void image(int seconds) {
    skill.process(stamped(0, image_type, four_tags().image(), seconds), out);
  }

  void info(int seconds, double zoom) {
    auto sent = four_tags().info();
    for (auto i : {0, 4})
      sent.k[i] *= zoom;
    for (auto i : {0, 5})
      sent.p[i] *= zoom;
    skill.process(stamped(1, info_type, ros2::serialize(sent), seconds), out);
  }

  said_lines said;
  collecting_emitter out;
  Executor skill;
};

/// Distances grow with the focal length.
double distance_in(const engine::frame& line) {
  return json::parse(line.payload)["tags"][0]["pose"]["position"][2];
}

} // namespace

TEST_CASE("an image has the CameraInfo of its stamp, or else the last",
          "[stamps]") {
  stamped_calibrations known;
  CHECK(known.of(at_s(1)) == nullptr);
  known.add(at_s(1), numbered(1));
  known.add(at_s(2), numbered(2));
  CHECK(known.of(at_s(1))->width == 1);
  CHECK(known.of(at_s(2))->width == 2);
  CHECK(known.of(at_s(3))->width == 2);
}

TEST_CASE("an image waits for its CameraInfo only where each has one",
          "[stamps]") {
  stamped_calibrations rare;
  rare.add(at_s(1), numbered(1));
  CHECK_FALSE(rare.should_wait(at_s(5)));
  CHECK_FALSE(rare.should_wait(at_s(6)));
  stamped_calibrations each;
  each.add(at_s(1), numbered(1));
  CHECK_FALSE(each.should_wait(at_s(1)));
  for (auto second = 2; second < 10; ++second) {
    CHECK(each.should_wait(at_s(second)));
    each.add(at_s(second), numbered(1));
  }
  // It comes no more.
  for (auto second = 10; second < 13; ++second)
    CHECK(each.should_wait(at_s(second)));
  CHECK_FALSE(each.should_wait(at_s(13)));
}

TEST_CASE("poses are of the CameraInfo of their image, which ever comes first",
          "[stamps]") {
  bench<pose::pose_estimator> b{lines_type, {{"tag_size_m", 0.16}}};
  b.info(1, 1);
  b.image(1);
  REQUIRE(b.out.of(0).size() == 1);
  const auto near = distance_in(b.out.of(0)[0]);
  // The image that comes before its CameraInfo waits for it.
  b.image(2);
  CHECK(b.out.of(0).size() == 1);
  b.info(2, 2);
  REQUIRE(b.out.of(0).size() == 2);
  CHECK(distance_in(b.out.of(0)[1]) == Approx(2 * near).epsilon(0.02));
  b.info(3, 1);
  b.info(4, 2);
  b.image(3);
  CHECK(distance_in(b.out.of(0)[2]) == Approx(near).epsilon(0.02));
  b.image(4);
  CHECK(distance_in(b.out.of(0)[3]) == Approx(2 * near).epsilon(0.02));
  // However often it changes.
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0], Contains("calibration changes while it runs"));
}

TEST_CASE("an image whose CameraInfo was lost is measured by the last one",
          "[stamps]") {
  bench<pose::pose_estimator> b{lines_type, {{"tag_size_m", 0.16}}};
  b.info(1, 1);
  b.image(1);
  b.image(2);
  CHECK(b.out.of(0).size() == 1);
  b.image(3);
  CHECK(b.out.of(0).size() == 2);
  b.info(3, 1);
  CHECK(b.out.of(0).size() == 3);
}

TEST_CASE("images are rectified by the CameraInfo of their stamp", "[stamps]") {
  bench<rectify::rectifier> b{info_type};
  const auto focal = [&] {
    return ros2::deserialize<ros2::sensor_msgs::camera_info>(
               b.out.of(0).back().payload)
        .k[0];
  };
  b.info(1, 1);
  b.image(1);
  REQUIRE(b.out.of(0).size() == 1);
  const auto first = focal();
  b.image(2);
  CHECK(b.out.of(0).size() == 1);
  b.info(2, 2);
  REQUIRE(b.out.of(0).size() == 2);
  CHECK(focal() == 2 * first);
  CHECK(b.said.lines().size() == 1);
}

TEST_CASE("of a camera that is well and not by turns no more is said at last",
          "[stamps]") {
  said_lines said;
  vision::complaint complaint{"'/eye': ", "'/eye' is well", said.function()};
  for (auto i = 0; i < 50; ++i)
    complaint.update(i % 2 == 0 ? "is ill" : "");
  REQUIRE(said.lines().size() == 10);
  CHECK_THAT(said.lines().back(), Contains("no more is said of it"));
}
