// The class without a node: lines of a file, and the messages as they should
// be. Usage: test_thermometer FOLDER_OF_THIS_FILE
#include "thermometer.hpp"

#include <roscell/ros2.hpp>
#include <roscell/ros2/lab_msgs.hpp>

#include <iostream>
#include <string>

using namespace roscell;
using ros2::lab_msgs::reading;

int main(int, char** argv) {
  thermometer subject{engine::environment{}};
  const auto results = engine::try_out(
      subject, argv[1] + std::string{"/temperatures.txt"}, "text/plain");
  std::string verdicts;
  for (const auto& x : results)
    verdicts += std::to_string(ros2::deserialize<reading>(x.payload).verdict);
  if (verdicts == "012")
    return 0;
  std::cerr << "the verdicts are " << verdicts << '\n';
  return 1;
}
