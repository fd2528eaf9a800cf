#pragma once

#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/topic_qos.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace roscell::ros2 {

struct heard_message {
  std::string payload; ///< As serialized, with its encapsulation.
  std::chrono::system_clock::time_point sent; ///< By the writer's clock.
};

/// Listens to one topic from outside of any skill, as long as it lives.
class topic_listener {
public:
  using callback = std::function<void(heard_message)>;

  /// `on_message` is called on a thread of Fast DDS, one call at a time. Throws
  /// engine::start_error.
  topic_listener(const participant_config& config, const std::string& topic,
                 const std::string& type, const topic_qos& qos,
                 callback on_message);
  ~topic_listener();

  topic_listener(const topic_listener&) = delete;
  topic_listener& operator=(const topic_listener&) = delete;

private:
  class impl;
  std::unique_ptr<impl> impl_;
};

} // namespace roscell::ros2
