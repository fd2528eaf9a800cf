#include "actors/placement/instance_specs.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

io_endpoint topic(const char* name) {
  return {"ros2", name, "sensor_msgs/msg/Image", "", false};
}

instance_spec step(const char* name, std::vector<io_endpoint> input,
                   std::vector<io_endpoint> output) {
  instance_spec result;
  result.step = name;
  result.input = std::move(input);
  result.output = std::move(output);
  return result;
}

} // namespace

TEST_CASE("an input names the step of its task that writes it") {
  std::vector<instance_spec> task{
      step("poses", {topic("scene/image"), topic("/elsewhere")}, {}),
      step("camera", {}, {topic("/scene/image")})};
  name_upstream_steps(task);
  CHECK(task[0].input[0].from == "camera");
  CHECK(task[0].input[1].from.empty());
}

TEST_CASE("an input from a program outside of the task names no step") {
  std::vector<instance_spec> task{step("poses", {topic("/image")}, {}),
                                  step("camera", {}, {topic("/image")})};
  task[0].input[0].external = true;
  name_upstream_steps(task);
  CHECK(task[0].input[0].from.empty());
}

TEST_CASE("a file and a topic of one name are two streams") {
  std::vector<instance_spec> task{
      step("reader", {{"file", "/image", "image/png", "", false}}, {}),
      step("camera", {}, {topic("/image")})};
  name_upstream_steps(task);
  CHECK(task[0].input[0].from.empty());
}
