#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"

#include <string>
#include <vector>

/// A cell's skills and pipelines for it, as their users write them.
namespace roscell::test {

inline skill_row skill_of(const std::string& operation,
                          const port_description& input,
                          const port_description& output,
                          const std::string& parameters = {}) {
  skill_row result;
  result.skill.hash = operation;
  auto& descriptor = result.skill.descriptor;
  descriptor.operation = operation;
  descriptor.engine = "primitive";
  descriptor.input = input;
  descriptor.output = output;
  implementation_model model;
  model.name = "m";
  model.parameters = parameters;
  deployment_option option;
  option.name = "cpu";
  model.deployments.push_back(option);
  descriptor.models.push_back(model);
  result.nodes = {"a", "b"};
  return result;
}

/// `camera` turns pictures into topics, `poses` takes them, `echo` knows files
/// of text only.
inline skill_list vision_skills() {
  const std::string image = "sensor_msgs/msg/Image";
  const std::string info = "sensor_msgs/msg/CameraInfo";
  return {
      {skill_of("camera", {{"image/png", "image/jpeg"}, {"file"}},
                {{image, info}, {"ros2"}},
                R"({"rate_hz": 5, "encoding": {"type": "string",
                        "default": "mono8", "values": ["mono8", "bgr8"]}})"),
       skill_of(
           "poses", {{image, info, "image/png"}, {"ros2", "file", "video"}},
           {{"tf2_msgs/msg/TFMessage", "application/json"}, {"ros2", "file"}},
           R"({"tag_size_m": {"type": "number", "default": 0.08,
                        "minimum": 0.0001, "maximum": 100, "unit": "m"}})"),
       skill_of("echo", {{"text/plain"}, {"file"}},
                {{"text/plain"}, {"file"}})},
      {}};
}

inline std::vector<task_step> steps_in(const std::string& text) {
  return json::parse(text).get<std::vector<task_step>>();
}

} // namespace roscell::test
