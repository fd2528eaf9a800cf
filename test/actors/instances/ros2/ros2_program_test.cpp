#include "actors/instances/ros2/ros2_program.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace roscell;

namespace {

using topics = std::vector<std::string>;

instance_spec spec_of_poses() {
  instance_spec result;
  result.instance = "fleet-poses.poses-1";
  result.input = {{"ros2", "/image", "sensor_msgs/msg/Image"},
                  {"file", "/data/in", "image"}};
  result.output = {{"ros2", "/poses", "tf2_msgs/msg/TFMessage"}};
  return result;
}

const std::vector<stream_count> counted(1);

} // namespace

TEST_CASE("the topics of a skill of our engine are looked for at the "
          "participant of its instance") {
  const auto request = engine_ends(spec_of_poses(), counted);
  REQUIRE(request);
  CHECK(request->instance == "fleet-poses.poses-1");
  CHECK(request->program == "fleet_poses_poses_1");
  CHECK(request->read == topics{"/image"});
  CHECK(request->written == topics{"/poses"});
}

TEST_CASE("what is not of our engine, or has no topics, is not looked for") {
  auto spec = spec_of_poses();
  CHECK_FALSE(engine_ends(spec, {}));
  spec.input.erase(spec.input.begin());
  spec.output.clear();
  CHECK_FALSE(engine_ends(spec, counted));
}

// test/ros2/participant_config_test.cpp says the same of the engine.
TEST_CASE("an instance has the name that the engine gives its participant") {
  CHECK(ros_name("poses") == "poses");
  CHECK(ros_name("7up") == "_7up");
  CHECK(ros_name("") == "_");
}

namespace {

using words = std::vector<std::string>;

/// What stands before a program's own words.
constexpr size_t script_words = 8;

instance_spec detector() {
  instance_spec result;
  result.instance = "fleet-tags-0a1b2c3d";
  result.task = "fleet";
  result.step = "tags-1";
  result.input = {{"ros2", "/fleet/camera/image", "sensor_msgs/msg/Image"},
                  {"ros2", "/fleet/camera/info", "sensor_msgs/msg/CameraInfo"}};
  result.output = {{"ros2", "/fleet/tags", "apriltag_msgs/msg/X"}};
  result.parameters = R"({"size":0.2})";
  return result;
}

ros2_program apriltag() {
  ros2_program result;
  result.package = "apriltag_ros";
  result.executable = "apriltag_node";
  result.parameters = R"({"family":"36h11","size":0.16})";
  result.topics = {{"image_rect", "input"},
                   {"camera_info", "input:1"},
                   {"detections", "output:0"}};
  return result;
}

ros2_start must_start(const ros2_program& program) {
  auto result = ros2_start_of(program, detector());
  if (const auto* why = std::get_if<failure>(&result))
    FAIL(why->message);
  return std::get<ros2_start>(result);
}

words own_announcement(const ros2_start& start) {
  return {start.command.begin() + script_words, start.command.end()};
}

} // namespace

TEST_CASE("a ROS 2 program gets its names, topics and parameters as ROS "
          "arguments") {
  const auto start = must_start(apriltag());
  CHECK(own_announcement(start)
        == words{"--ros-args", "-r", "__node:=tags_1", "-r", "__ns:=/fleet",
                 "--enclave", "/fleet_tags_0a1b2c3d", "-r",
                 "camera_info:=/fleet/camera/info", "-r",
                 "detections:=/fleet/tags", "-r",
                 "image_rect:=/fleet/camera/image", "-p", R"(family:="36h11")",
                 "-p", "size:=0.2"});
  CHECK(start.command[4] == "run");
  CHECK(start.command[5] == "apriltag_ros");
  CHECK(start.command[6] == "apriltag_node");
  CHECK(start.command[7] == "0");
}

TEST_CASE("a ROS 2 program is ready once it has the ends of its step") {
  const auto& ends = must_start(apriltag()).endpoints;
  CHECK(ends.instance == "fleet-tags-0a1b2c3d");
  CHECK(ends.program == "/fleet_tags_0a1b2c3d");
  CHECK(ends.written == words{"/fleet/tags"});
  auto read = ends.read;
  std::sort(read.begin(), read.end());
  CHECK(read == words{"/fleet/camera/image", "/fleet/camera/info"});
}

TEST_CASE("a ROS 2 program without topics is known by what every node "
          "writes") {
  auto program = apriltag();
  program.topics.clear();
  CHECK(must_start(program).endpoints.written == words{"/rosout"});
}

TEST_CASE("a launch file gets topics and parameters as its arguments") {
  auto program = apriltag();
  program.executable.clear();
  program.launch = "tags.launch.py";
  program.setup = {"/opt/line/setup.bash"};
  program.arguments = {"mode:=fast"};
  const auto start = must_start(program);
  CHECK(start.command[4] == "launch");
  CHECK(start.command[6] == "tags.launch.py");
  CHECK(start.command[7] == "1");
  CHECK(own_announcement(start)
        == words{"/opt/line/setup.bash", "mode:=fast",
                 "camera_info:=/fleet/camera/info", "detections:=/fleet/tags",
                 "image_rect:=/fleet/camera/image", "family:=36h11",
                 "size:=0.2"});
  CHECK(start.endpoints.program.empty());
}

TEST_CASE("a ROS 2 program gets values in the types that its model declares") {
  skill_descriptor skill;
  skill.ros2 = {apriltag()};
  skill.ros2.front().topics.clear();
  skill.ros2.front().parameters.clear();
  skill.models = {{"m",
                   R"({"size": {"type": "number"}, "n": 1,
                       "at": {"type": "array", "items": "number"}})",
                   {}}};
  auto spec = detector();
  spec.model = "m";
  spec.parameters = R"({"at":[1,2],"n":3,"size":2})";
  spec.arguments = {"--log-level", "debug"};
  const auto start = ros2_start_of(skill, spec);
  REQUIRE(std::holds_alternative<ros2_start>(start));
  const auto said = own_announcement(std::get<ros2_start>(start));
  CHECK(words{said.begin(), said.begin() + 2} == words{"--log-level", "debug"});
  CHECK(words{said.end() - 6, said.end()}
        == words{"-p", "at:=[1.0,2.0]", "-p", "n:=3", "-p", "size:=2.0"});
}

TEST_CASE("a parameter that no ROS 2 program can be given is refused by name") {
  auto spec = detector();
  spec.parameters = R"({"pose": {"x": 1}})";
  const auto start = ros2_start_of(apriltag(), spec);
  REQUIRE(std::holds_alternative<failure>(start));
  CHECK(std::get<failure>(start).message.find("/pose: expected no object")
        != std::string::npos);
}

TEST_CASE("a topic that stands for an end that the step has not is refused") {
  auto program = apriltag();
  program.topics["depth"] = "input:2";
  const auto start = ros2_start_of(program, detector());
  REQUIRE(std::holds_alternative<failure>(start));
  CHECK(std::get<failure>(start).message
        == "the topic 'depth' of its program stands for 'input:2', which step "
           "'tags-1' has not");
}

TEST_CASE("a topic that stands for no end at all is refused, not guessed") {
  for (const auto* place :
       {"input:x", "input:1x", "input:", "input:-1", "input: 1", "input:01",
        "input:99999999999999999999", "inputs", "output:+0", "stdin", ""}) {
    auto program = apriltag();
    program.topics["depth"] = place;
    INFO(place);
    CHECK(std::holds_alternative<failure>(ros2_start_of(program, detector())));
  }
}
