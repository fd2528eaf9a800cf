#include "roscell/ros2.hpp"
#include "roscell/skill.hpp"
#include "skills/image_source/image_source.hpp"
#include "skills/video/video_protocol.hpp"

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<roscell::source::image_source>("video");
  roscell::video::add_video_protocol(parts);
  roscell::ros2::add_ros2_protocol(parts);
  return roscell::engine::run(parts, argc, argv);
}
