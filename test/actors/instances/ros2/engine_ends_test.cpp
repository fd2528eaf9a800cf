#include "actors/instances/ros2/engine_ends.hpp"

#include "actors/instances/ros2/ros_name.hpp"

#include <catch2/catch.hpp>

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

// test/ros2/names_test.cpp says the same of the engine.
TEST_CASE("an instance has the name that the engine gives its participant") {
  CHECK(ros_name("poses") == "poses");
  CHECK(ros_name("7up") == "_7up");
  CHECK(ros_name("") == "_");
}
