#include "roscell/skill/errors.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"

#include "test/vision/fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace roscell;
using namespace roscell::test;
using Catch::Matchers::Contains;
using nlohmann::json;
using strings = std::vector<std::string>;

namespace {

/// One or two cameras that both see `four_tags`.
struct bench {
  explicit bench(std::size_t cameras, json options = json::object())
      : skill(environment(cameras, std::move(options)), said.function()) {
    for (std::size_t k = 0; k < cameras; ++k)
      skill.process(make_frame(cameras + k, info_type,
                               ros2::serialize(four_tags().info())),
                    out);
  }

  static engine::environment environment(std::size_t cameras, json options) {
    strings inputs(cameras, image_type);
    inputs.insert(inputs.end(), cameras, info_type);
    options["tag_size_m"] = 0.16;
    return make_environment(inputs, {transforms_type, lines_type}, options);
  }

  strings see(std::size_t camera, const std::string& image) {
    skill.process(make_frame(camera, image_type, image), out);
    last =
        ros2::deserialize<ros2::tf2_msgs::tf_message>(out.of(0).back().payload);
    strings result;
    for (const auto& x : last.transforms)
      result.push_back(x.child_frame_id);
    return result;
  }

  json line() {
    return json::parse(out.of(1).back().payload);
  }

  said_lines said;
  collecting_emitter out;
  pose::pose_estimator skill;
  ros2::tf2_msgs::tf_message last;
};

/// The picture of four tags with one of them a second time.
rendered_scene scene_of_twins() {
  auto tags = four_tags().tags;
  tags[0].id = tags[1].id;
  return render(four_tags().options, tags);
}

} // namespace

TEST_CASE("a tag that is twice in an image is out of TF, and told once",
          "[frames]") {
  const auto scene = scene_of_twins();
  const auto twin = scene.tags[0].id;
  bench b{1};
  for (auto i = 0; i < 3; ++i) {
    const auto frames = b.see(0, scene.image());
    CHECK(frames.size() == 2);
    CHECK(std::find(frames.begin(), frames.end(),
                    "tag36h11:" + std::to_string(twin))
          == frames.end());
  }
  REQUIRE(b.said.lines().size() == 1);
  CHECK_THAT(b.said.lines()[0],
             Contains("/in_0") && Contains("more than once")
                 && Contains("tag36h11:" + std::to_string(twin)));
  const auto tags = b.line()["tags"];
  REQUIRE(tags.size() == 4);
  for (const auto& tag : tags)
    CHECK(tag["in_tf"] == (tag["id"] != twin));
}

TEST_CASE("a tag that two cameras see is sent by the first, and told once",
          "[frames]") {
  bench b{2};
  const auto image = four_tags().image();
  for (auto i = 0; i < 2; ++i) {
    CHECK(b.see(0, image).size() == 4);
    CHECK(b.see(1, image).empty());
  }
  REQUIRE(b.said.lines().size() == 4);
  CHECK_THAT(b.said.lines()[0], Contains("'/in_1' and '/in_0' both see")
                                    && Contains("'tag_prefixes'"));
}

TEST_CASE("cameras have prefixes and frames of their own", "[frames]") {
  bench b{2,
          {{"tag_prefixes", {"left/", ""}}, {"frame_ids", {"eye_left", ""}}}};
  const auto image = four_tags().image();
  CHECK(b.see(0, image).front() == "left/tag36h11:0");
  CHECK(b.last.transforms[0].header.frame_id == "eye_left");
  CHECK(b.see(1, image).front() == "tag36h11:0");
  CHECK(b.last.transforms[0].header.frame_id == "eye");
  CHECK(b.said.lines().empty());
}

TEST_CASE("a tag moves on to another camera once the first has lost it",
          "[frames]") {
  using pose::frame_keeper;
  said_lines said;
  frame_keeper keeper{said.function()};
  const auto start = frame_keeper::clock::now();
  CHECK(keeper.may_send(0, "tag", 0, "left", start));
  CHECK_FALSE(keeper.may_send(0, "tag", 1, "right",
                              start + std::chrono::milliseconds{900}));
  CHECK(keeper.may_send(0, "tag", 1, "right",
                        start + std::chrono::milliseconds{1100}));
  CHECK_FALSE(keeper.may_send(0, "tag", 0, "left",
                              start + std::chrono::milliseconds{1200}));
}

TEST_CASE("frames that are out of view are forgotten", "[frames]") {
  using pose::frame_keeper;
  said_lines said;
  frame_keeper keeper{said.function()};
  auto now = frame_keeper::clock::now();
  for (auto i = 0; i < 20'000; ++i) {
    now += std::chrono::milliseconds{2};
    CHECK(keeper.may_send(0, "tag" + std::to_string(i), 0, "eye", now));
  }
  CHECK(keeper.count() <= frame_keeper::most_frames);
  CHECK_FALSE(keeper.may_send(0, "tag19999", 1, "other", now));
}

TEST_CASE("cameras whose transforms go to topics of their own may see the same",
          "[frames]") {
  using pose::frame_keeper;
  said_lines said;
  frame_keeper keeper{said.function()};
  const auto now = frame_keeper::clock::now();
  CHECK(keeper.may_send(0, "tag", 0, "left", now));
  CHECK(keeper.may_send(1, "tag", 1, "right", now));
  CHECK(said.lines().empty());
}

TEST_CASE("a prefix or frame is given for each camera or for none",
          "[frames]") {
  CHECK_THROWS_WITH((bench{2, {{"tag_prefixes", {"left/"}}}}),
                    Contains("'tag_prefixes' has 1 texts")
                        && Contains("2 image inputs"));
  CHECK_THROWS_AS((bench{1, {{"frame_ids", {"a", "b"}}}}), engine::start_error);
}
