#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace roscell::cli {

/// What an event means to somebody who waits, in lines; none: nothing.
using event_line_function =
    std::function<std::vector<std::string>(const event& e)>;

/// Tells on standard error what a node does, from the node's own events. Silent
/// until `begin`, which then first tells what was missed.
class progress {
public:
  /// `node` must outlive this. Never fails: without events there is just no
  /// progress to be told.
  progress(const node_client& node, event_line_function lines);

  void begin();

private:
  void print_line(const std::string& line);

  event_line_function lines_;
  std::mutex mutex_;
  bool begun_ = false;
  std::vector<std::string> held_; ///< Lines until `begin`.
  event_follower events_;         // Last: it uses all the others.
};

/// `node_client::post` of a request. If the reply takes longer than a second,
/// what goes on meanwhile is told on standard error.
json post_with_progress(const node_client& node, const std::string& body,
                        std::chrono::milliseconds limit,
                        event_line_function lines);

} // namespace roscell::cli
