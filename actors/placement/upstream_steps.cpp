#include "actors/placement/upstream_steps.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "messages/stream_protocols.hpp"

#include <algorithm>

namespace roscell {

namespace {

bool same_stream(const io_endpoint& x, const io_endpoint& y) {
  return x.protocol == y.protocol
         && (x.protocol == protocols::ros2
                 ? full_topic(x.endpoint) == full_topic(y.endpoint)
                 : x.endpoint == y.endpoint);
}

bool writes(const instance_spec& step, const io_endpoint& input) {
  return std::any_of(
      step.output.begin(), step.output.end(),
      [&](const io_endpoint& x) { return same_stream(x, input); });
}

} // namespace

void name_upstream_steps(std::vector<instance_spec>& task) {
  for (auto& reader : task)
    for (auto& input : reader.input) {
      const auto writer =
          std::find_if(task.begin(), task.end(),
                       [&](const auto& x) { return writes(x, input); });
      if (!input.external && writer != task.end())
        input.from = writer->step;
    }
}

} // namespace roscell
