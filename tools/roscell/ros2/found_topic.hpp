#pragma once

#include "messages/topic.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/topic_qos.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/view/views.hpp"

#include <functional>
#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// Which topic of which cell is listened to.
struct topic_choice {
  connection_options connection;
  std::string topic;
};

/// Adds TOPIC, and the options that say which node is asked.
void add_topic_choice(CLI::App& command, topic_choice& choice);

/// A topic, and how its cell is entered.
struct found_topic {
  topic_row row;
  ros2::participant_config config;
  ros2::topic_qos qos; ///< Matches every writer, and takes all that they offer.
};

/// Throws command_error when the node is in no cell, or nobody writes the
/// topic.
found_topic find_topic(const topic_choice& choice);
found_topic find_topic(const node_client& node, const std::string& topic);

/// Runs what listens to a topic; what DDS refuses is a command_error.
int listen(const std::function<int()>& command);

} // namespace roscell::cli

namespace roscell::cli {

/// The topics with who is at their ends; below them, what does not match.
std::string topics_view(const topic_list& topics, const view_style& style);

} // namespace roscell::cli
