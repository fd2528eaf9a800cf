#include "thermometer.hpp"

#include <roscell/ros2.hpp>
#include <roscell/ros2/lab_msgs.hpp>

#include <string>

using namespace roscell;
using ros2::lab_msgs::reading;

thermometer::thermometer(const engine::environment& env)
    : warm_c_(env.parameters.number("warm_c", 15, -273.15, 1e4)),
      hot_c_(env.parameters.number("hot_c", 30, -273.15, 1e4)) {
  if (hot_c_ < warm_c_)
    throw engine::start_error("parameter 'hot_c' must not be below 'warm_c'");
}

void thermometer::process(const engine::frame& input, engine::emitter& output) {
  reading result;
  result.header.stamp = ros2::to_time(input.time);
  result.header.frame_id = "lab";
  result.temperature_c = std::stod(input.payload);
  if (result.temperature_c >= hot_c_)
    result.verdict = reading::HOT;
  else if (result.temperature_c >= warm_c_)
    result.verdict = reading::WARM;
  output.emit(ros2::serialize(result));
}

void thermometer::release() {
  // Nothing is held.
}
