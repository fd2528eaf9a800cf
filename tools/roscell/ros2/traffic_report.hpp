#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/ros2/traffic_meter.hpp"

#include <chrono>
#include <string>

namespace roscell::cli {

/// How often a line is printed, as by `ros2 topic hz`.
inline constexpr std::chrono::seconds traffic_print_period{1};

/// The line of text about a topic at `now`: its metrics, or, when nothing came
/// for a period, how long that is. Metrics of a topic that has fallen silent
/// would read as if it went on.
std::string traffic_line(const traffic_meter& meter,
                         traffic_meter::clock::time_point now);

/// The same for programs. It has metrics while messages come, and "silent_s",
/// the time since the last message, always.
json traffic_json(const traffic_meter& meter,
                  traffic_meter::clock::time_point now);

} // namespace roscell::cli
