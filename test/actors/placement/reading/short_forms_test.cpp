#include "actors/placement/reading/short_forms.hpp"
#include "test/actors/placement/reading/pipelines.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

written_pipeline written(const std::string& pipeline) {
  return write_out("fleet-poses", steps_in(pipeline), vision_skills(),
                   "/pipeline");
}

std::string end_text(const io_endpoint& x) {
  return x.protocol + " " + x.endpoint + " " + x.data_type;
}

std::vector<std::string> inputs(const written_pipeline& x, size_t step) {
  std::vector<std::string> result;
  for (const auto& end : x.steps[step].step.input)
    result.push_back(end_text(end));
  return result;
}

std::vector<std::string> outputs(const written_pipeline& x, size_t step) {
  std::vector<std::string> result;
  for (const auto& end : x.steps[step].step.output)
    result.push_back(end_text(end));
  return result;
}

schema_error only_error(const written_pipeline& x) {
  REQUIRE(x.errors.size() == 1);
  return x.errors.front();
}

constexpr auto camera =
    R"({"id": "camera", "operation": "camera", "model": "m",
        "input": "/data/frames/one.png"})";

std::string with_camera(const std::string& step) {
  return "[" + std::string{camera} + "," + step + "]";
}

} // namespace

TEST_CASE("A step that is named as input gives all that the reader takes",
          "[short_forms]") {
  const auto x = written(with_camera(R"({"id": "poses", "operation": "poses",
                              "model": "m", "input": {"from": "camera"}})"));
  CHECK(x.errors.empty());
  const std::vector<std::string> topics{
      "ros2 /fleet_poses/camera/image sensor_msgs/msg/Image",
      "ros2 /fleet_poses/camera/camera_info sensor_msgs/msg/CameraInfo"};
  CHECK(outputs(x, 0) == topics);
  CHECK(inputs(x, 1) == topics);
  CHECK(inputs(x, 0)
        == std::vector<std::string>{"file /data/frames/one.png image/png"});
}

TEST_CASE("A named output is the only one that is taken", "[short_forms]") {
  const auto x =
      written(with_camera(R"({"id": "poses", "operation": "poses", "model": "m",
                      "input": {"from": "camera.image"}})"));
  CHECK(x.errors.empty());
  CHECK(inputs(x, 1).size() == 1);
  CHECK(outputs(x, 0) == inputs(x, 1));
}

TEST_CASE("An output that is said goes before one that is made up",
          "[short_forms]") {
  const auto x = written(R"([
    {"id": "camera", "operation": "camera", "model": "m", "input": "/d/x.png",
     "output": "/scene_1/image"},
    {"id": "poses", "operation": "poses", "model": "m",
     "input": {"from": "camera"}},
    {"id": "again", "operation": "poses", "model": "m",
     "input": {"from": "camera.image"}}])");
  CHECK(x.errors.empty());
  const std::vector<std::string> topic{
      "ros2 /scene_1/image sensor_msgs/msg/Image"};
  CHECK(outputs(x, 0) == topic);
  CHECK(inputs(x, 1) == topic);
  CHECK(inputs(x, 2) == topic);
}

TEST_CASE("Who names no output gets images in one form, the plain one",
          "[short_forms]") {
  auto skills = vision_skills();
  const std::string compressed = "sensor_msgs/msg/CompressedImage";
  skills.skills[0].skill.descriptor.output.data_types.push_back(compressed);
  skills.skills[1].skill.descriptor.input.data_types.push_back(compressed);
  const auto read = [&](const std::string& input, const std::string& output) {
    std::string eye{camera};
    eye.insert(eye.size() - 1, output);
    auto pipeline =
        steps_in("[" + eye + R"(, {"id": "poses", "operation": "poses",
                                 "model": "m", "input": )"
                 + input + "}]");
    return inputs(write_out("fleet", pipeline, skills, "/pipeline"), 1);
  };
  const std::string image = "ros2 /fleet/camera/image sensor_msgs/msg/Image";
  const std::string info =
      "ros2 /fleet/camera/camera_info sensor_msgs/msg/CameraInfo";
  CHECK(read(R"({"from": "camera"})", "") == std::vector{image, info});
  CHECK(read(R"({"from": "camera.compressed_image"})", "")
        == std::vector{"ros2 /fleet/camera/compressed_image " + compressed});
  CHECK(read(R"({"from": "camera"})",
             R"(, "output": {"endpoint": "/image/compressed", "data_type":
                 "sensor_msgs/msg/CompressedImage"})")
        == std::vector{"ros2 /image/compressed " + compressed});
}

TEST_CASE("The protocol of a lone endpoint follows from its form",
          "[short_forms]") {
  const auto x = written(R"([
    {"id": "a", "operation": "poses", "model": "m", "input": "/dev/video0"},
    {"id": "b", "operation": "poses", "model": "m", "input": "rtsp://cam/1"},
    {"id": "c", "operation": "poses", "model": "m", "input": "/tmp/x.png",
     "output": ["/tmp/poses.jsonl", "/scene/tf"]},
    {"id": "d", "operation": "poses", "model": "m",
     "input": ["/scene/image", "/scene/camera_info"]},
    {"id": "e", "operation": "echo", "model": "m", "input": "/anywhere",
     "output": "/elsewhere"}])");
  CHECK(x.errors.empty());
  CHECK(inputs(x, 0)[0] == "video /dev/video0 sensor_msgs/msg/Image");
  CHECK(inputs(x, 1)[0] == "video rtsp://cam/1 sensor_msgs/msg/Image");
  CHECK(inputs(x, 2)[0] == "file /tmp/x.png image/png");
  CHECK(outputs(x, 2)
        == std::vector<std::string>{"file /tmp/poses.jsonl application/json",
                                    "ros2 /scene/tf tf2_msgs/msg/TFMessage"});
  CHECK(inputs(x, 3)
        == std::vector<std::string>{
            "ros2 /scene/image sensor_msgs/msg/Image",
            "ros2 /scene/camera_info sensor_msgs/msg/CameraInfo"});
  CHECK(inputs(x, 4)[0] == "file /anywhere text/plain");
}

TEST_CASE("What is written out already stays", "[short_forms]") {
  const auto steps = steps_in(R"([{"id": "a", "operation": "camera",
    "model": "m", "input": {"protocol": "file", "endpoint": "/d",
    "data_type": "image/png"}}])");
  const auto x = write_out("t", steps, vision_skills(), "/pipeline");
  CHECK(x.errors.empty());
  CHECK(x.steps[0].step == steps[0]);
}

TEST_CASE("A short form that leads nowhere is refused at its place",
          "[short_forms]") {
  const auto step = [](const std::string& input) {
    return written(with_camera(
        R"({"id": "poses", "operation": "poses", "model": "m", "input": )"
        + input + "}"));
  };
  auto error = only_error(step(R"({"from": "camra.image"})"));
  CHECK(error.pointer == "/pipeline/1/input/from");
  CHECK(error.expected
        == R"(there is no step "camra"; did you mean "camera"?)");
  error = only_error(step(R"([{"from": "camera"}, {"from": "camera.depth"}])"));
  CHECK(error.pointer == "/pipeline/1/input/1/from");
  CHECK(error.expected.find(R"(it has "image", "camera_info")")
        != std::string::npos);
  error = only_error(step(R"({"from": "poses"})"));
  CHECK(error.expected == "a step cannot read what it writes");
  error = only_error(step(R"({"from": "camera", "endpoint": "/x"})"));
  CHECK(error.pointer == "/pipeline/1/input");
  error = only_error(step(R"({"protocol": "ros2"})"));
  CHECK(error.expected.find("expected an endpoint") == 0);
}

TEST_CASE("Steps without a common protocol are not joined", "[short_forms]") {
  const auto error = only_error(
      written(with_camera(R"({"id": "e", "operation": "echo", "model": "m",
                              "input": {"from": "camera"}})")));
  CHECK(error.expected.find(R"(step "e" takes none of what step "camera")")
        == 0);
}

TEST_CASE("A step whose skill nobody has stays as it is", "[short_forms]") {
  const auto x = written(R"([{"id": "a", "operation": "camra", "model": "m",
                              "input": "/x"},
                             {"id": "b", "operation": "poses", "model": "m",
                              "input": {"from": "a"}}])");
  CHECK(x.errors.empty());
  CHECK(x.steps[0].step.input[0].protocol.empty());
}

} // namespace roscell::test
