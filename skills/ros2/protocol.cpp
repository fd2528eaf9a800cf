#include "roscell/ros2.hpp"

#include "skills/ros2/services/parameter_server.hpp"
#include "skills/ros2/topic_input.hpp"
#include "skills/ros2/topic_output.hpp"

#include <cstdlib>
#include <memory>

namespace roscell::ros2 {

// All protocols, with a sentence on each: messages/stream_protocols.hpp.
void add_ros2_protocol(engine::registry& target) {
  ::setenv("SKIP_DEFAULT_XML", "1", 1);
  add_ros2_protocol(target, [](const char* name) -> const char* {
    return std::getenv(name);
  });
}

void add_ros2_protocol(engine::registry& target,
                       const engine::variable_lookup& lookup) {
  auto shared = std::make_shared<shared_participant>(lookup);
  target.add_input("ros2", [shared](const engine::stream_context& input) {
    return std::make_unique<topic_input>(input, shared);
  });
  target.set_parameter_view(
      "ros2",
      [shared](const engine::environment& env, const engine::say_function& say,
               const engine::request_function& request) {
        return std::make_unique<parameter_server>(env, shared, say, request);
      });
  target.add_output("ros2", [shared](const engine::stream_context& output) {
    return std::make_unique<topic_output>(output, shared);
  });
}

} // namespace roscell::ros2
