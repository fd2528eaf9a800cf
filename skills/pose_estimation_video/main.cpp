#include "roscell/ros2.hpp"
#include "roscell/skill.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/video/video_protocol.hpp"

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<roscell::pose::pose_estimator>("apriltag3_video");
  roscell::video::add_video_protocol(parts);
  roscell::ros2::add_ros2_protocol(parts);
  return roscell::engine::run(parts, argc, argv);
}
