#include "roscell/ros2.hpp"
#include "roscell/skill.hpp"
#include "skills/convert/converter.hpp"

int main(int argc, char** argv) {
  roscell::engine::registry parts;
  parts.add_executor<roscell::convert::converter>("pixels");
  roscell::ros2::add_ros2_protocol(parts);
  return roscell::engine::run(parts, argc, argv);
}
