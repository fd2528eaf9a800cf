#include "actors/instances/ros2/engine_ends.hpp"

#include "actors/instances/ros2/ros_name.hpp"
#include "messages/stream_protocols.hpp"

#include <string>

namespace roscell {

namespace {

std::vector<std::string> topics_of(const std::vector<io_endpoint>& ends) {
  std::vector<std::string> result;
  for (const auto& x : ends)
    if (x.protocol == protocols::ros2)
      result.push_back(x.endpoint);
  return result;
}

} // namespace

std::optional<watch_endpoints>
engine_ends(const instance_spec& spec,
            const std::vector<stream_count>& frames) {
  watch_endpoints result{spec.instance, ros_name(spec.instance),
                         topics_of(spec.output), topics_of(spec.input)};
  if (frames.empty() || (result.written.empty() && result.read.empty()))
    return std::nullopt;
  return result;
}

} // namespace roscell
