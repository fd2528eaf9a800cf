#include "cell_fixture.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/ros2/topic_input.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

constexpr const char* image = ros2::sensor_msgs::image::type_name;

/// An image with a stamp, of one row for each number of pixels.
std::string image_payload(std::uint32_t height, std::uint32_t width) {
  std::vector<std::uint8_t> pixels(std::size_t{height} * width * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  return ros2::serialize(ros2::image_view{{{12, 500}, "cam"},
                                          height,
                                          width,
                                          "rgb8",
                                          0,
                                          width * 3,
                                          pixels.data(),
                                          pixels.size()});
}

} // namespace

TEST_CASE_METHOD(two_skills, "a message reaches the readers of its cell") {
  running_input input{reading.input("/chatter", text)};
  auto output = writing.output("/chatter", text);
  REQUIRE(writing.log.wait_for("'/chatter': a reader has come; now 1"));
  REQUIRE(reading.log.wait_for("'/chatter': a writer has come; now 1"));
  output->write(text_frame("hello"));
  auto first = input.sink().wait_for(0);
  CHECK(text_of(first) == "hello");
  CHECK(first->name == "chatter-1");
  CHECK(first->time.time_since_epoch() > std::chrono::hours{24 * 365 * 50});
  output->close();
  output.reset();
  CHECK(reading.log.wait_for("'/chatter': a writer has left; now 0"));
}

TEST_CASE("two cells with the same topic never see each other's messages") {
  // In one ROS domain, so that nothing but the servers keeps them apart.
  cell first{1, 3};
  cell second{2, 3};
  skill reading_first{first.environment("reader")};
  skill reading_second{second.environment("reader")};
  skill writing_first{first.environment("writer")};
  skill writing_second{second.environment("writer")};
  running_input input_first{reading_first.input("/chatter", text)};
  running_input input_second{reading_second.input("/chatter", text)};
  auto output_first = writing_first.output("/chatter", text);
  auto output_second = writing_second.output("/chatter", text);
  REQUIRE(writing_first.log.wait_for("has come; now 1"));
  REQUIRE(writing_second.log.wait_for("has come; now 1"));
  constexpr std::size_t count = 20;
  for (std::size_t i = 0; i < count; ++i) {
    output_first->write(text_frame("first"));
    output_second->write(text_frame("second"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(text_of(input_first.sink().wait_for(i)) == "first");
    CHECK(text_of(input_second.sink().wait_for(i)) == "second");
  }
  // Nobody ever matched more than the one of its own cell.
  for (auto* log : {&reading_first.log, &reading_second.log, &writing_first.log,
                    &writing_second.log})
    CHECK(log->lines().size() == 1);
}

TEST_CASE_METHOD(
    two_skills,
    "an image of megabytes arrives whole, with its stamp as its time") {
  reading.parameters = {{"ros2_reliability", "reliable"}};
  running_input input{reading.input("/scene_1/image", image)};
  auto output = writing.output("/scene_1/image", image);
  REQUIRE(writing.log.wait_for("has come; now 1"));
  auto payload = image_payload(960, 1280);
  output->write(frame_of(image, payload));
  auto got = input.sink().wait_for(0);
  REQUIRE(got);
  CHECK(got->payload == payload);
  CHECK(got->name == "scene_1_image-1");
  CHECK(got->time == ros2::to_time_point({12, 500}));
  CHECK(input.sink().policies().front() == engine::when_full::drop_oldest);
}

TEST_CASE_METHOD(two_skills,
                 "an image whose sizes lie is refused by who looks at it") {
  running_input input{reading.input("/image", image)};
  auto output = writing.output("/image", image);
  // A reader with best effort gets nothing before it knows the writer.
  REQUIRE(writing.log.wait_for("has come; now 1"));
  REQUIRE(reading.log.wait_for("has come; now 1"));
  auto payload = image_payload(2, 2);
  // The height, behind the header of "cam".
  REQUIRE(payload[20] == 2);
  payload[20] = 3;
  output->write(frame_of(image, payload));
  auto got = input.sink().wait_for(0);
  REQUIRE(got);
  CHECK_THROWS_WITH(ros2::view_image(got->payload),
                    "field 'data': 12 bytes are not 3 rows of 6 bytes");
}

TEST_CASE("a reader that comes late gets the static transforms") {
  const auto* type = ros2::tf2_msgs::tf_message::type_name;
  cell home{0};
  skill writing{home.environment("writer")};
  auto output = writing.output("/tf_static", type);
  ros2::tf2_msgs::tf_message sent{{{{{1, 2}, "map"}, "camera", {}}}};
  output->write(frame_of(type, ros2::serialize(sent)));
  skill reading{home.environment("reader")};
  running_input input{reading.input("/tf_static", type)};
  auto got = input.sink().wait_for(0);
  REQUIRE(got);
  CHECK(ros2::deserialize<ros2::tf2_msgs::tf_message>(got->payload) == sent);
}

TEST_CASE_METHOD(
    two_skills,
    "a reader that wants more than is offered says which parameter to "
    "set") {
  reading.parameters = {{"ros2_reliability", "reliable"}};
  writing.parameters = {{"ros2_reliability", "best_effort"}};
  running_input input{reading.input("/chatter", text)};
  auto output = writing.output("/chatter", text);
  const auto remedy = "set parameter 'ros2_reliability' to 'best_effort'";
  CHECK(reading.log.wait_for(remedy));
  CHECK(writing.log.wait_for(remedy));
}

TEST_CASE("a skill reads several topics with one participant") {
  cell home{0};
  skill both{home.environment("both")};
  skill writing{home.environment("writer")};
  running_input left{both.input("/left", text)};
  running_input right{both.input("/right", text)};
  auto to_left = writing.output("/left", text);
  auto to_right = writing.output("/right", text);
  REQUIRE(writing.log.wait_for("'/left': a reader has come"));
  REQUIRE(writing.log.wait_for("'/right': a reader has come"));
  to_left->write(text_frame("l"));
  to_right->write(text_frame("r"));
  CHECK(text_of(left.sink().wait_for(0)) == "l");
  CHECK(text_of(right.sink().wait_for(0)) == "r");
  auto wrong = both.input("/left", image);
  CHECK_THROWS_WITH(wrong->open(), Catch::Contains("with two types"));
}

TEST_CASE("an output refuses frames that are no message of its type") {
  cell home{0};
  skill writing{home.environment("writer")};
  auto output = writing.output("/chatter", text);
  CHECK_THROWS_AS(output->write(frame_of(image, image_payload(1, 1))),
                  engine::stream_error);
  CHECK_THROWS_AS(output->write(frame_of(text, "hi")), engine::stream_error);
}

TEST_CASE("an output that nobody reads closes at once") {
  cell home{0};
  skill writing{home.environment("writer")};
  auto output = writing.output("/chatter", text);
  output->write(text_frame("into the void"));
  output->close();
  CHECK(writing.log.lines().empty());
}

TEST_CASE("a skill can be in the highest ROS domain") {
  two_skills x{232};
  running_input input{x.reading.input("/chatter", text)};
  auto output = x.writing.output("/chatter", text);
  REQUIRE(x.writing.log.wait_for("has come; now 1"));
  output->write(text_frame("hello"));
  CHECK(text_of(input.sink().wait_for(0)) == "hello");
}

namespace {

/// An input that moves within its cell, as where its host has another address.
class moving_input {
public:
  moving_input(skill& of, cell& home, const std::string& topic)
      : home_(home), handler_(of.input(topic, text)), moved_(handler_.get()),
        input_(std::move(handler_)) {
    // nop
  }

  void suspend() {
    moved_->suspend();
  }

  void resume() {
    moved_->resume(home_.environment("reader"));
  }

  std::string text_at(std::size_t n) {
    return text_of(input_.sink().wait_for(n));
  }

private:
  cell& home_;
  std::unique_ptr<engine::input_handler> handler_;
  engine::input_handler* moved_;
  running_input input_;
};

} // namespace

TEST_CASE_METHOD(two_skills, "an input that moves counts what it has missed") {
  moving_input input{reading, home, "/chatter"};
  auto output = writing.output("/chatter", text);
  REQUIRE(reading.log.wait_for("a writer has come"));
  REQUIRE(writing.log.wait_for("a reader has come"));
  output->write(text_frame("one"));
  CHECK(input.text_at(0) == "one");
  input.suspend();
  output->write(text_frame("missed"));
  output->write(text_frame("missed"));
  input.resume();
  REQUIRE(reading.log.wait_for("a writer has come", 2));
  REQUIRE(writing.log.wait_for("a reader has come", 2));
  output->write(text_frame("two"));
  CHECK(input.text_at(1) == "two");
  CHECK(reading.log.wait_for("'/chatter' has lost 2 messages on the way"));
}

TEST_CASE_METHOD(
    two_skills,
    "an input that moves gets nothing twice of what a writer keeps") {
  for (auto* end : {&reading, &writing})
    end->parameters = {{"ros2_durability", "transient_local"}};
  moving_input input{reading, home, "/map"};
  auto output = writing.output("/map", text);
  output->write(text_frame("one"));
  CHECK(input.text_at(0) == "one");
  input.suspend();
  output->write(text_frame("two"));
  input.resume();
  output->write(text_frame("three"));
  CHECK(input.text_at(1) == "two");
  CHECK(input.text_at(2) == "three");
}

TEST_CASE("an output that moves writes again what it keeps for late readers") {
  cell home{0};
  cell other{1};
  skill reading{other.environment("reader")};
  skill writing{home.environment("writer")};
  for (auto* end : {&reading, &writing})
    end->parameters = {{"ros2_durability", "transient_local"},
                       {"ros2_depth", 2}};
  auto output = writing.output("/map", text);
  for (const auto* word : {"one", "two", "three"})
    output->write(text_frame(word));
  output->suspend();
  output->resume(other.environment("writer"));
  running_input input{reading.input("/map", text)};
  CHECK(text_of(input.sink().wait_for(0)) == "two");
  CHECK(text_of(input.sink().wait_for(1)) == "three");
  output->write(text_frame("four"));
  CHECK(text_of(input.sink().wait_for(2)) == "four");
}

TEST_CASE("messages that are missing between two of a writer are counted") {
  ros2::gap_counter gaps;
  const ros2::guid one{1};
  const ros2::guid two{2};
  CHECK(gaps.add(one, 17) == 0); // Those before are not ours.
  CHECK(gaps.add(one, 18) == 0);
  CHECK(gaps.add(one, 21) == 2);
  CHECK(gaps.add(two, 1) == 0);
  CHECK(gaps.add(one, 20) == 0); // Late, or twice: nothing is missing.
  CHECK(gaps.add(one, 22) == 0);
}
