#include "thermometer.hpp"

#include <roscell/ros2.hpp>

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<thermometer>("plain");
  roscell::ros2::add_ros2_protocol(parts);
  return roscell::engine::run(parts, argc, argv);
}
