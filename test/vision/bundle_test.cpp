#include "skills/pose_estimation/bundle_pose.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/pose_estimation/tag_pose.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace roscell;
using namespace roscell::pose;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

constexpr auto size_m = 0.16;
const camera_model eye{600, 600, 320, 240};

/// Four tags on a board, the fourth on a face that stands out of it.
bundle board() {
  bundle result{"board", {}};
  const Eigen::Vector3d places[] = {
      {-0.2, -0.2, 0}, {0.2, -0.2, 0}, {0.2, 0.2, 0}, {-0.2, 0.2, 0.05}};
  for (auto id = 0; id < 4; ++id)
    result.tags.push_back(
        {id, size_m, {Eigen::Matrix3d::Identity(), places[id]}});
  result.tags[3].place.rotation =
      Eigen::AngleAxisd{0.4, Eigen::Vector3d::UnitY()}.toRotationMatrix();
  return result;
}

json described(const bundle& body) {
  auto tags = json::array();
  for (const auto& tag : body.tags) {
    const auto& p = tag.place.translation;
    const Eigen::Quaterniond q{tag.place.rotation};
    tags.push_back({{"id", tag.id},
                    {"size_m", tag.size_m},
                    {"position", {p.x(), p.y(), p.z()}},
                    {"orientation", {q.x(), q.y(), q.z(), q.w()}}});
  }
  return json::array({{{"name", body.name}, {"tags", tags}}});
}

class noisy_world {
public:
  /// The board in view, tilted up to 45 degrees.
  rigid_transform next_pose() {
    const auto z = between(0.9, 1.8);
    const Eigen::AngleAxisd facing{M_PI, Eigen::Vector3d::UnitX()};
    const auto around = between(0, 2 * M_PI);
    const Eigen::AngleAxisd tilt{
        between(0, M_PI / 4),
        Eigen::Vector3d{std::cos(around), std::sin(around), 0}};
    return {(facing * tilt).toRotationMatrix(),
            {between(-0.15, 0.15) * z, between(-0.1, 0.1) * z, z}};
  }

  /// The tag where `pose` puts it, its corners off by `noise_px`.
  tag_detection see(const bundled_tag& tag, const rigid_transform& pose,
                    double noise_px) {
    const auto at = pose * tag.place;
    tag_detection result;
    result.id = tag.id;
    result.corners = project_corners(
        {at.translation, Eigen::Quaterniond{at.rotation}}, tag.size_m, eye);
    std::normal_distribution<> noise{0, noise_px};
    for (auto& corner : result.corners)
      corner += Eigen::Vector2d{0.5 + noise(random_), 0.5 + noise(random_)};
    return result;
  }

  double between(double least, double most) {
    return std::uniform_real_distribution{least, most}(random_);
  }

private:
  std::mt19937 random_{1};
};

double turn_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::Quaterniond{a}.angularDistance(Eigen::Quaterniond{b}) * 180
         / M_PI;
}

std::vector<tag_detection> see_all(noisy_world& world, const bundle& body,
                                   const rigid_transform& pose,
                                   double noise_px) {
  std::vector<tag_detection> result;
  for (const auto& tag : body.tags)
    result.push_back(world.see(tag, pose, noise_px));
  return result;
}

std::string error_of(const json& bundles) {
  try {
    bundles_of(parameters_of({{"bundles", bundles}}), size_m);
  } catch (const engine::start_error& e) {
    return e.what();
  }
  return "none";
}

} // namespace

TEST_CASE("a body of four tags is placed with half the error of one tag",
          "[bundle]") {
  const auto body = board();
  noisy_world world;
  double off_bundle_m = 0;
  double off_tag_m = 0;
  double off_bundle_deg = 0;
  double off_tag_deg = 0;
  for (auto i = 0; i < 200; ++i) {
    const auto truth = world.next_pose();
    const auto seen = see_all(world, body, truth, 0.3);
    const auto sight = locate(body, seen, eye);
    REQUIRE(sight.where);
    CHECK(sight.where->used.size() == 4);
    off_bundle_m += (sight.where->pose.translation - truth.translation).norm();
    off_bundle_deg += turn_deg(sight.where->pose.rotation, truth.rotation);
    const auto alone = estimate_pose(seen[0].camera_corners(), size_m, eye);
    REQUIRE(alone);
    const auto tag_truth = truth * body.tags[0].place;
    off_tag_m += (alone->position - tag_truth.translation).norm();
    off_tag_deg +=
        turn_deg(alone->orientation.toRotationMatrix(), tag_truth.rotation);
  }
  CHECK(off_bundle_m < off_tag_m / 2);
  CHECK(off_bundle_deg < off_tag_deg / 2);
}

TEST_CASE("a body is placed by those of its tags that are seen", "[bundle]") {
  const auto body = board();
  noisy_world world;
  for (auto hidden = 0; hidden < 4; ++hidden) {
    const auto truth = world.next_pose();
    auto seen = see_all(world, body, truth, 0.1);
    seen.erase(seen.begin() + hidden);
    const auto sight = locate(body, seen, eye);
    REQUIRE(sight.where);
    CHECK(sight.where->used.size() == 3);
    CHECK((sight.where->pose.translation - truth.translation).norm() < 0.01);
    // One alone will do, too.
    CHECK(locate(body, {seen[0]}, eye).where);
  }
  const auto nothing = locate(body, {}, eye);
  CHECK_FALSE(nothing.where);
  CHECK_FALSE(nothing.ambiguous);
}

TEST_CASE("a tag that is not where its bundle says is left out", "[bundle]") {
  const auto body = board();
  auto moved = body;
  moved.tags[2].place.translation += Eigen::Vector3d{0.08, 0.03, 0};
  noisy_world world;
  for (auto i = 0; i < 20; ++i) {
    const auto truth = world.next_pose();
    const auto seen = see_all(world, moved, truth, 0.2);
    const auto sight = locate(body, seen, eye);
    REQUIRE(sight.where);
    CHECK(sight.where->strayed == std::vector<int>{2});
    CHECK((sight.where->pose.translation - truth.translation).norm() < 0.02);
    // Nobody can say which of two is right.
    const auto two = locate(body, {seen[1], seen[2]}, eye);
    CHECK_FALSE(two.where);
    CHECK(two.ambiguous);
  }
}

TEST_CASE("the covariance of a body is the spread of its poses", "[bundle]") {
  const auto body = board();
  noisy_world world;
  const auto truth = world.next_pose();
  constexpr auto rounds = 300;
  Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 1> reported = squares;
  for (auto i = 0; i < rounds; ++i) {
    const auto sight = locate(body, see_all(world, body, truth, 0.4), eye);
    REQUIRE(sight.where);
    const auto& found = *sight.where;
    const Eigen::AngleAxisd turn{
        Eigen::Matrix3d{found.pose.rotation * truth.rotation.transpose()}};
    Eigen::Matrix<double, 6, 1> off;
    off << found.pose.translation - truth.translation,
        turn.axis() * turn.angle();
    squares += off.cwiseProduct(off) / rounds;
    for (auto k = 0; k < 6; ++k)
      reported[k] += found.covariance[static_cast<std::size_t>(7 * k)] / rounds;
  }
  for (auto k = 0; k < 6; ++k) {
    CAPTURE(k);
    CHECK(reported[k] / squares[k] == Approx(1).margin(0.3));
  }
}

TEST_CASE("a rendered board is told as a frame, a detection and a line",
          "[bundle]") {
  auto body = board();
  // Tags of the renderer are as large as each other, on any face.
  noisy_world world;
  const auto truth = world.next_pose();
  std::vector<scenes::placed_tag> tags;
  for (const auto& tag : body.tags) {
    const auto at = truth * tag.place;
    tags.push_back({tag.id, at.translation, Eigen::Quaterniond{at.rotation}});
  }
  const auto scene = render(small_scene(4), tags);
  said_lines said;
  collecting_emitter out;
  pose_estimator skill{
      make_environment({image_type, info_type},
                       {transforms_type, detections3d_type, lines_type},
                       {{"tag_size_m", 0.1},
                        {"bundles", described(body)},
                        {"tag_prefixes", {"left/"}}}),
      said.function()};
  skill.process(make_frame(1, info_type, ros2::serialize(scene.info())), out);
  skill.process(make_frame(0, image_type, scene.image()), out);
  CHECK(said.lines().empty());
  const auto tf =
      ros2::deserialize<ros2::tf2_msgs::tf_message>(out.of(0).back().payload);
  REQUIRE(tf.transforms.size() == 5);
  CHECK(tf.transforms[4].child_frame_id == "left/board");
  const auto off =
      difference(tf.transforms[4].transform,
                 {0, truth.translation, Eigen::Quaterniond{truth.rotation}});
  CHECK(off.distance_percent < 0.5);
  CHECK(off.rotation_deg < 0.5);
  const auto detections =
      ros2::deserialize<ros2::vision_msgs::detection3_d_array>(
          out.of(1).back().payload);
  REQUIRE(detections.detections.size() == 5);
  CHECK(detections.detections[4].id == "left/board");
  CHECK(detections.detections[4].results[0].pose.covariance[0] > 0);
  // A single tag tells less.
  CHECK(detections.detections[0].results[0].pose.covariance[14]
        > detections.detections[4].results[0].pose.covariance[14]);
  const auto line = json::parse(out.of(2).back().payload);
  CHECK(line["bundles"][0]["tags"] == json({0, 1, 2, 3}));
  CHECK(line["bundles"][0]["pose"]["covariance"].size() == 36);
}

TEST_CASE("tags of a bundle that stray are said once", "[bundle]") {
  auto body = board();
  std::vector<scenes::placed_tag> tags;
  noisy_world world;
  const auto truth = world.next_pose();
  for (const auto& tag : body.tags) {
    const auto at = truth * tag.place;
    tags.push_back({tag.id, at.translation, Eigen::Quaterniond{at.rotation}});
  }
  const auto scene = render(small_scene(4), tags);
  body.tags[1].place.translation.x() += 0.06;
  said_lines said;
  collecting_emitter out;
  pose_estimator skill{make_environment({image_type, info_type},
                                        {transforms_type},
                                        {{"bundles", described(body)}}),
                       said.function()};
  skill.process(make_frame(1, info_type, ros2::serialize(scene.info())), out);
  for (auto i = 0; i < 3; ++i)
    skill.process(make_frame(0, image_type, scene.image()), out);
  REQUIRE(said.lines().size() == 1);
  CHECK_THAT(said.lines()[0], Contains("tag 1 of bundle 'board'")
                                  && Contains("measure its place again"));
}

TEST_CASE("a bundle that makes no sense is refused with its place",
          "[bundle]") {
  const json tag{{"id", 3}, {"position", {0, 0, 0}}};
  const auto named = [](const std::string& name, const json& tags) {
    return json{{"name", name}, {"tags", json::array({tags})}};
  };
  const auto of = [&](const json& only) {
    return json::array({named("b", only)});
  };
  CHECK(error_of(of(tag)) == "none");
  CHECK_THAT(error_of(json::object()), Contains("'bundles' at /"));
  CHECK_THAT(error_of(json::array({1})), Contains("at /0 must be an object"));
  CHECK_THAT(error_of(json::array({json{{"name", "b"}}})),
             Contains("1 to 1000 'tags'"));
  CHECK_THAT(error_of(json::array({named("b", tag), named("c", tag)})),
             Contains("at /1/tags/0 has an id that another tag"));
  auto other = tag;
  other["id"] = 4;
  CHECK_THAT(error_of(json::array({named("b", tag), named("b", other)})),
             Contains("at /1 has the name of another bundle"));
  auto odd = tag;
  odd["position"] = {0, 0};
  CHECK_THAT(error_of(of(odd)), Contains("/0/tags/0/position must be 3"));
  odd = tag;
  odd["size_m"] = -1;
  CHECK_THAT(error_of(of(odd)), Contains("/size_m must be from"));
  odd = tag;
  odd["orientation"] = {0, 0, 0, 0};
  CHECK_THAT(error_of(of(odd)), Contains("of length 1"));
  odd = tag;
  odd["id"] = -1;
  CHECK_THAT(error_of(of(odd)), Contains("'id' of a tag"));
}
